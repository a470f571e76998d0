// SPDX-License-Identifier: Apache-2.0
// Shared by all shaders. Colours are RGBA8 in one number, red in the lowest byte.

// Red, green and blue of a colour times factor / 256 (0..256); alpha 0.
uint dimmed(uint colour, uint factor) {
  uint red_blue = ((colour & 0xff00ffu) * factor >> 8) & 0xff00ffu;
  uint green = ((colour & 0x00ff00u) * factor >> 8) & 0x00ff00u;
  return red_blue | green;
}

// The mean of four levels by their weights (of 65,536), nearly of their squares, times `factor`: as
// mix() in renderer/draw/cpu/sampler.hpp, bit by bit.
float sum_of(uvec4 levels, uvec4 weights) {
  uvec4 parts = levels * (levels + 1u) * weights >> 16;
  return float(parts.x + parts.y + parts.z + parts.w);
}
uint mixed(uvec4 texels, uvec4 weights, float factor) {
  vec3 sums = vec3(sum_of(texels & 0xffu, weights), sum_of(texels >> 8 & 0xffu, weights),
                   sum_of(texels >> 16 & 0xffu, weights));
  uvec3 levels = uvec3(sqrt(sums * (65536.0 / 65280.0) + 0.95) * factor + (0.5 - 0.5 * factor));
  return levels.r | levels.g << 8 | levels.b << 16;
}

// Reads a mip chain (renderer/base/mip_chain.hpp) as the cpu painter does. Texture coordinates
// outside 0..1 are clamped. `picture`: width, height and padded height of the picture in texels,
// and its last level; -1: the nearest texel of the only level is read. `factor`: of the levels,
// 0..1. Alpha of the result: 0.
uint picture_at(usampler2D texels, ivec4 picture, vec2 uv, int level, float factor) {
  bool smooth_picture = picture.w >= 0;
  vec2 size = vec2(picture.xy) * float(256 >> level) / 256.0;
  ivec2 place = ivec2(256.0 * (min(max(uv, 0.0), 1.0) * size + (smooth_picture ? 0.5 : 1.0)));
  uvec2 part = smooth_picture ? uvec2(place & 255) : uvec2(0u);
  place >>= 8;
  place.y += 2 * level + 2 * (picture.z - (picture.z >> level));
  uint both = part.x * part.y >> 8;
  uvec4 weights = 255u * uvec4(256u - part.x - part.y + both, part.x - both, part.y - both, both);
  uvec4 four = uvec4(texelFetch(texels, place, 0).r, texelFetch(texels, place + ivec2(1, 0), 0).r,
                     texelFetch(texels, place + ivec2(0, 1), 0).r,
                     texelFetch(texels, place + ivec2(1, 1), 0).r);
  return mixed(four, weights, factor);
}
