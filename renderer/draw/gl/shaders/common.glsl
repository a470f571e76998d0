// SPDX-License-Identifier: Apache-2.0
// Shared by all shaders. Colours are RGBA8 in one number, red in the lowest byte.

// Red, green and blue of a colour times factor / 256 (0..256); alpha 0.
uint dimmed(uint colour, uint factor) {
  uint red_blue = ((colour & 0xff00ffu) * factor >> 8) & 0xff00ffu;
  uint green = ((colour & 0x00ff00u) * factor >> 8) & 0x00ff00u;
  return red_blue | green;
}

// Reads a mip chain (renderer/base/mip_chain.hpp) as the cpu painter does. Texture coordinates
// outside 0..1 are clamped. `picture`: width, height and padded height of the picture in texels,
// and its last level; -1: the nearest texel of the only level is read. Alpha of the result: any.
uint picture_at(usampler2D texels, ivec4 picture, vec2 uv, int level) {
  vec2 size = vec2(picture.xy);
  if (picture.w < 0)
    return texelFetch(texels, 1 + ivec2(min(max(uv * size, 0.0), size - 1.0)), 0).r;
  size *= float(256 >> level) / 256.0;
  ivec2 place = ivec2(256.0 * (min(max(uv * size, 0.0), size) + 0.5));
  ivec2 part = place & 255;
  place >>= 8;
  place.y += 2 * level + 2 * (picture.z - (picture.z >> level));
  int both = part.x * part.y >> 8;
  vec4 weights = vec4(256 - part.x - part.y + both, part.x - both, part.y - both, both);
  uvec4 texel = uvec4(texelFetch(texels, place, 0).r, texelFetch(texels, place + ivec2(1, 0), 0).r,
                      texelFetch(texels, place + ivec2(0, 1), 0).r,
                      texelFetch(texels, place + ivec2(1, 1), 0).r);
  // The light of a level is taken as its square.
  vec4 red = vec4(texel & 0xffu), green = vec4(texel >> 8 & 0xffu), blue = vec4(texel >> 16 & 0xffu);
  uvec3 level_rgb = uvec3(sqrt(vec3(dot(weights, red * red), dot(weights, green * green),
                                    dot(weights, blue * blue))) / 16.0 + 0.5);
  return level_rgb.r | level_rgb.g << 8 | level_rgb.b << 16;
}
