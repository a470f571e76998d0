// SPDX-License-Identifier: Apache-2.0
layout(location = 0) in vec3 uv_light;
layout(location = 1) flat in uint id;

layout(binding = 0) uniform usampler2D content;

layout(location = 0) out vec2 out_uv;
layout(location = 1) out uvec2 out_tag;
layout(location = 2) out uint out_colour;

void main() {
  uint level = uint(clamp(uv_light.z + 0.5, 0.0, 256.0));
  uint texel = texelFetch(content, texel_at(uv_light.xy, textureSize(content, 0)), 0).r;
  out_uv = uv_light.xy;
  out_tag = uvec2(id, level - (level >> 8));
  out_colour = dimmed(texel, level) | 0xff000000u;
}
