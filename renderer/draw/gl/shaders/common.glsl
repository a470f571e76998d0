// SPDX-License-Identifier: Apache-2.0
// Shared by all shaders. Colours are RGBA8 in one number, red in the lowest byte.

// Red, green and blue of a colour times factor / 256 (0..256); alpha 0.
uint dimmed(uint colour, uint factor) {
  uint red_blue = ((colour & 0xff00ffu) * factor >> 8) & 0xff00ffu;
  uint green = ((colour & 0x00ff00u) * factor >> 8) & 0x00ff00u;
  return red_blue | green;
}

// The nearest texel of a picture of this size. Coordinates outside 0..1 are clamped.
ivec2 texel_at(vec2 uv, ivec2 size) {
  return ivec2(min(max(uv * vec2(size), 0.0), vec2(size) - 1.0));
}
