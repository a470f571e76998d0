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

layout(binding = 1) uniform usampler2D content0;  // of the four hands
layout(binding = 2) uniform usampler2D content1;
layout(binding = 3) uniform usampler2D content2;
layout(binding = 4) uniform usampler2D content3;
layout(binding = 0, rg8ui) uniform restrict uimage2D tag;
layout(binding = 1, r32ui) uniform restrict writeonly uimage2D colour;
layout(binding = 2, rg32f) uniform restrict image2D uv;

struct Limit {
  uint strength;           // of the light, 0..256
  float squared_limit_uv;  // longest step that does not cross a seam, squared
};
layout(binding = 0, std430) restrict readonly buffer Words { uint lit_words[]; };
layout(binding = 1, std430) restrict readonly buffer List { uint wanted[]; };
layout(binding = 2, std430) restrict buffer Counts {
  uint groups_x, groups_y, groups_z;
  uint lit_count, wanted_count, filled_count;
};
layout(binding = 3, std430) restrict readonly buffer Table { Limit limits[]; };  // by squared px

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

uint content_texel(uint hand, vec2 at) {
  switch (hand) {
    case 0u: return texelFetch(content0, texel_at(at, textureSize(content0, 0)), 0).r;
    case 1u: return texelFetch(content1, texel_at(at, textureSize(content1, 0)), 0).r;
    case 2u: return texelFetch(content2, texel_at(at, textureSize(content2, 0)), 0).r;
    default: return texelFetch(content3, texel_at(at, textureSize(content3, 0)), 0).r;
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
  uvec2 surface_light = imageLoad(tag, seed).rg;
  vec2 coordinates = imageLoad(uv, seed).rg;
  if (is_lit(mirror) && imageLoad(tag, mirror).r == surface_light.r) {
    vec2 step_uv = coordinates - imageLoad(uv, mirror).rg;
    if (dot(step_uv, step_uv) <= limit.squared_limit_uv) coordinates += step_uv;
  }
  uint texel = content_texel(surface_light.r / 64u, coordinates);
  uint light = surface_light.g;
  uint factor = (light + (light >> 7)) * limit.strength >> 8;
  uint alpha = max(1u, 255u * limit.strength >> 8);
  imageStore(uv, at, vec4(coordinates, 0, 0));
  imageStore(tag, at, uvec4(surface_light, 0, 0));
  imageStore(colour, at, uvec4(dimmed(texel, factor) | alpha << 24));
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
