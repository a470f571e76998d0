// SPDX-License-Identifier: Apache-2.0
layout(location = 0) in vec3 uv_light;
layout(location = 1) flat in uint id;

layout(location = 2) uniform ivec4 picture;
layout(binding = 0) uniform usampler2D content;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out uvec4 out_tag;
layout(location = 2) out uint out_colour;

// The level of the picture that has about one texel per pixel in this triangle: half the binary
// logarithm of the texels per pixel, rounded.
int level_here() {
  vec2 right = dFdx(uv_light.xy), down = dFdy(uv_light.xy);
  float ratio = abs(right.x * down.y - right.y * down.x) * float(picture.x) * float(picture.y);
  int exponent = (floatBitsToInt(2.0 * ratio) >> 23) - 127;
  return clamp(exponent >> 1, 0, max(picture.w, 0));
}

void main() {
  uint light = uint(clamp(uv_light.z + 0.5, 0.0, 255.0));
  int level = level_here();
  out_uv = uv_light.xy;
  out_tag = uvec4(id, light, level, 0);
  out_colour = picture_at(content, picture, uv_light.xy, level, float(light) / 255.0) | 0xff000000u;
}
