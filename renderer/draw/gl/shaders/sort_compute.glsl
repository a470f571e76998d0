// SPDX-License-Identifier: Apache-2.0
// First step of the fill: sorts the pixels of the region. One invocation per 32 rows of a column.
//   lit (region D of the paper):   drawing and hand; a bit of its word is set
//   wanted (region C):             hand without drawing; added to the list
//   drawing without hand:          made dark
// A lit pixel that is hand in part gets this part of its light.
layout(local_size_x = 64) in;

layout(location = 0) uniform ivec4 region;  // x0, y0, x1, y1

layout(binding = 0) uniform usampler2D mask;
layout(binding = 0, rgba8ui) uniform restrict uimage2D tag;
layout(binding = 1, r32ui) uniform restrict uimage2D colour;

layout(binding = 0, std430) restrict writeonly buffer Words { uint lit_words[]; };
layout(binding = 1, std430) restrict writeonly buffer List { uint wanted[]; };
layout(binding = 2, std430) restrict buffer Counts {
  uint groups_x, groups_y, groups_z;  // of the second step
  uint lit_count, wanted_count, filled_count;
};

layout(binding = 4, std430) restrict readonly buffer Shares { uint share_factors[256]; };

void main() {
  int x = region.x + int(gl_GlobalInvocationID.x);
  if (x >= region.z) return;
  int top = (region.y / 32 + int(gl_WorkGroupID.y)) * 32;
  int first = max(top, region.y), last = min(top + 32, region.w);
  uint lit_word = 0u, wanted_word = 0u;
  for (int y = first; y < last; ++y) {
    ivec2 at = ivec2(x, y);
    uint share = texelFetch(mask, at, 0).r;
    bool hand = share != 0u;
    bool light = imageLoad(tag, at).r != 0u;
    uint bit = 1u << (y - top);
    if (hand && light) lit_word |= bit;
    if (hand && light && share != 255u)
      imageStore(colour, at, uvec4(dimmed(imageLoad(colour, at).r, share_factors[share]) | share << 24));
    if (hand && !light) wanted_word |= bit;
    if (!hand && light) {
      imageStore(tag, at, uvec4(0));
      imageStore(colour, at, uvec4(0));
    }
  }
  lit_words[gl_WorkGroupID.y * uint(region.z - region.x) + gl_GlobalInvocationID.x] = lit_word;
  if (lit_word != 0u) atomicAdd(lit_count, uint(bitCount(lit_word)));
  if (wanted_word == 0u) return;
  uint count = uint(bitCount(wanted_word));
  uint next = atomicAdd(wanted_count, count);
  atomicMax(groups_x, min((next + count + 63u) / 64u, 65535u));
  for (; wanted_word != 0u; wanted_word &= wanted_word - 1u)
    wanted[next++] = uint(top + findLSB(wanted_word)) << 16 | uint(x);
}
