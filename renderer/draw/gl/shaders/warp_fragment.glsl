// SPDX-License-Identifier: Apache-2.0
// Copies the nearest pixel of the drawing. Dark pixels are copied too, because a later cell hides an
// earlier one.
layout(location = 0) in vec2 source_px;

layout(binding = 0) uniform sampler2D uv;
layout(binding = 1) uniform usampler2D tag;
layout(binding = 2) uniform usampler2D colour;
layout(location = 1) uniform ivec4 from;  // x0, y0, x1, y1

layout(location = 0) out vec2 out_uv;
layout(location = 1) out uvec4 out_tag;
layout(location = 2) out uint out_colour;

void main() {
  ivec2 at = ivec2(source_px + 0.5);
  bool inside = all(greaterThanEqual(at, from.xy)) && all(lessThan(at, from.zw));
  at = clamp(at, from.xy, from.zw - 1);
  out_uv = texelFetch(uv, at, 0).rg;
  out_tag = inside ? texelFetch(tag, at, 0) : uvec4(0);
  out_colour = inside ? texelFetch(colour, at, 0).r : 0u;
}
