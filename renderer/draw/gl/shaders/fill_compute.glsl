// SPDX-License-Identifier: Apache-2.0
// Second step of the fill: finds the nearest lit pixel of each wanted one, exactly, and continues
// the drawing from there (docs/method.md#fill). One invocation per wanted pixel.
//
// The nearest lit pixel of a column follows from three words of bits, so one look covers 32 rows up
// and down. Columns are searched outwards until none can have a nearer one. Among equally near
// pixels, that in the nearer column is taken, then the left one, then the upper one.
layout(local_size_x = 64) in;

layout(location = 0) uniform ivec4 region;  // x0, y0, x1, y1
layout(location = 1) uniform int reach_px;  // at most 32
layout(location = 2) uniform ivec4 pictures[4];

layout(binding = 0) uniform usampler2D mask;
layout(binding = 1) uniform usampler2D content0;  // of the four hands
layout(binding = 2) uniform usampler2D content1;
layout(binding = 3) uniform usampler2D content2;
layout(binding = 4) uniform usampler2D content3;
layout(binding = 0, rgba8ui) uniform restrict uimage2D tag;
layout(binding = 1, r32ui) uniform restrict writeonly uimage2D colour;
layout(binding = 2, rg32f) uniform restrict image2D uv;

struct Limit {
  uint strength;           // of the levels, 0..256
  uint alpha;              // that share of the light, 1..255
  float squared_limit_uv;  // longest step that does not cross a seam, squared
};
layout(binding = 0, std430) restrict readonly buffer Words { uint lit_words[]; };
layout(binding = 1, std430) restrict readonly buffer List { uint wanted[]; };
layout(binding = 2, std430) restrict buffer Counts {
  uint groups_x, groups_y, groups_z;
  uint lit_count, wanted_count, filled_count;
};
layout(binding = 3, std430) restrict readonly buffer Table { Limit limits[]; };  // by squared px
layout(binding = 4, std430) restrict readonly buffer Shares { uint share_factors[256]; };

const int kNone = 1000;  // rows; out of reach

int first_row = region.y / 32, word_rows = (region.w + 31) / 32 - first_row,
    width = region.z - region.x;

uint word(int x, int row) {
  return row < 0 || row >= word_rows ? 0u : lit_words[row * width + x - region.x];
}

bool is_lit(ivec2 at) {
  return at.x >= region.x && at.x < region.z && at.y >= region.y && at.y < region.w &&
         (word(at.x, at.y / 32 - first_row) >> (at.y & 31) & 1u) != 0u;
}

// Rows from y to the nearest lit pixel of a column.
int rows_to_lit(int x, int y) {
  int row = y / 32 - first_row, bit = y & 31;
  uint here = word(x, row);
  int up = findMSB(here << (31 - bit)), down = findLSB(here >> bit);
  if (up >= 0) {
    up = 31 - up;
  } else {
    up = findMSB(word(x, row - 1));
    up = up < 0 ? kNone : bit + 32 - up;
  }
  if (down < 0) {
    down = findLSB(word(x, row + 1));
    down = down < 0 ? kNone : 32 - bit + down;
  }
  return down < up ? down : -up;
}

uint content_at(uint hand, vec2 at, int level, float factor) {
  switch (hand) {
    case 0u: return picture_at(content0, pictures[0], at, level, factor);
    case 1u: return picture_at(content1, pictures[1], at, level, factor);
    case 2u: return picture_at(content2, pictures[2], at, level, factor);
    default: return picture_at(content3, pictures[3], at, level, factor);
  }
}

// The vector to the nearest lit pixel.
ivec2 nearest_lit(ivec2 at) {
  ivec2 nearest = ivec2(0, rows_to_lit(at.x, at.y));
  int best = nearest.y * nearest.y;
  for (int d = 1; d <= reach_px && d * d < best; ++d) {
    for (int side = -1; side <= 1; side += 2) {
      int x = at.x + side * d;
      if (x < region.x || x >= region.z) continue;
      int rows = rows_to_lit(x, at.y), square = d * d + rows * rows;
      if (square >= best) continue;
      best = square;
      nearest = ivec2(side * d, rows);
    }
  }
  return nearest;
}

bool fill(ivec2 at) {
  ivec2 to_seed = nearest_lit(at);
  int square = to_seed.x * to_seed.x + to_seed.y * to_seed.y;
  if (square > reach_px * reach_px) return false;
  Limit limit = limits[square];
  if (limit.strength == 0u) return false;

  ivec2 seed = at + to_seed, mirror = seed + to_seed;
  uvec4 seen = imageLoad(tag, seed);  // surface, light, level
  vec2 coordinates = imageLoad(uv, seed).rg;
  if (is_lit(mirror) && imageLoad(tag, mirror).r == seen.r) {
    vec2 step_uv = coordinates - imageLoad(uv, mirror).rg;
    if (dot(step_uv, step_uv) <= limit.squared_limit_uv) coordinates += step_uv;
  }
  float factor = float(seen.g * limit.strength) / (255.0 * 256.0);
  uint filled = content_at(seen.r / 64u, coordinates, int(seen.b), factor);
  uint share = texelFetch(mask, at, 0).r;
  if (share != 255u) filled = dimmed(filled, share_factors[share]);
  imageStore(uv, at, vec4(coordinates, 0, 0));
  imageStore(tag, at, seen);
  imageStore(colour, at, uvec4(filled | max(limit.alpha * share / 255u, 1u) << 24));
  return true;
}

void main() {
  uint filled = 0u;
  for (uint i = gl_GlobalInvocationID.x; i < wanted_count; i += gl_NumWorkGroups.x * 64u) {
    ivec2 at = ivec2(wanted[i] & 0xffffu, wanted[i] >> 16);
    if (fill(at)) ++filled;
  }
  if (filled != 0u) atomicAdd(filled_count, filled);
}
