// SPDX-License-Identifier: Apache-2.0
layout(location = 0) in vec4 node;  // moved position and position at rest, px

layout(location = 0) uniform vec2 size_px;

layout(location = 0) out vec2 source_px;

void main() {
  source_px = node.zw;
  gl_Position = vec4((node.xy + 0.5) * 2.0 / size_px - 1.0, 0.0, 1.0);
}
