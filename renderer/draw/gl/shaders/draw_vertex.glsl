// SPDX-License-Identifier: Apache-2.0
layout(location = 0) in vec2 uv;
layout(location = 1) in uint chart;
layout(location = 2) in vec4 placed;  // x and y in projector px, depth in m, light 0..255

layout(location = 0) uniform vec2 size_px;
layout(location = 1) uniform uint first_id;  // of the hand; the chart is added

layout(location = 0) out vec3 uv_light;
layout(location = 1) flat out uint id;

void main() {
  uv_light = vec3(uv, placed.w);
  id = first_id + chart;
  // Pixel centres are at whole px. A power of two keeps the order of depths exactly.
  gl_Position = vec4((placed.xy + 0.5) * 2.0 / size_px - 1.0, placed.z / 1024.0, 1.0);
}
