// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/jump_flood.hpp"

#include <vector>

namespace handcast::bench {
namespace {

using namespace renderer::gl;

constexpr std::string_view kWholeScreen = R"(
void main() {
  gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 4 * (gl_VertexID >> 1) - 1, 0, 1);
})";

/// Each pixel takes the nearest of the seeds that it and eight pixels around it know.
constexpr std::string_view kStep = R"(
layout(binding = 0) uniform isampler2D nearest;
layout(location = 0) uniform int step_px;
layout(location = 0) out ivec2 found;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(nearest, 0);
  int best = 1 << 30;
  found = ivec2(-1);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      ivec2 from = clamp(at + step_px * ivec2(dx, dy), ivec2(0), size - 1);
      ivec2 seed = texelFetch(nearest, from, 0).rg, away = seed - at;
      int square = away.x * away.x + away.y * away.y;
      if (seed.x >= 0 && square < best) { best = square; found = seed; }
    }
  }
})";

}  // namespace

Result<JumpFlood> JumpFlood::create(renderer::View<const std::uint8_t> seeds) {
  auto context = Context::open();
  if (!context) return tl::make_unexpected(context.error());
  JumpFlood flood;
  flood.context_ = std::move(*context);
  auto program = make_program(*flood.context_, {{GL_VERTEX_SHADER, "whole_screen", kWholeScreen},
                                                {GL_FRAGMENT_SHADER, "step", kStep}});
  if (!program) return tl::make_unexpected(program.error());
  flood.program_ = std::move(*program);
  flood.nothing_ = make_vertex_array(*flood.context_);
  std::vector<std::int16_t> positions;
  for (int y = 0; y < seeds.height; ++y)
    for (int x = 0; x < seeds.width; ++x)
      for (const int value : {x, y})
        positions.push_back(static_cast<std::int16_t>(seeds.at(x, y) ? value : -1));
  const Functions& gl = flood.context_->gl();
  for (int i = 0; i < 2; ++i) {
    flood.nearest_[i] = make_image(*flood.context_, GL_RG16I, seeds.width, seeds.height);
    flood.targets_[i] = make_framebuffer(*flood.context_);
    gl.TextureSubImage2D(flood.nearest_[i].name(), 0, 0, 0, seeds.width, seeds.height,
                         GL_RG_INTEGER, GL_SHORT, positions.data());
    gl.NamedFramebufferTexture(flood.targets_[i].name(), GL_COLOR_ATTACHMENT0,
                               flood.nearest_[i].name(), 0);
  }
  gl.Viewport(0, 0, seeds.width, seeds.height);
  gl.Enable(GL_SCISSOR_TEST);
  return flood;
}

void JumpFlood::flood(const renderer::Rect& region, int passes, bool leads) {
  context_->make_current();
  const Functions& gl = context_->gl();
  gl.UseProgram(program_.name());
  gl.BindVertexArray(nothing_.name());
  gl.Scissor(region.x0, region.y0, region.width(), region.height());
  int from = 0;
  const auto step = [&](int step_px) {
    gl.ProgramUniform1i(program_.name(), 0, step_px);
    gl.BindTextureUnit(0, nearest_[from].name());
    from = 1 - from;
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, targets_[from].name());
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
  };
  if (leads) step(1);
  for (int pass = passes - 1; pass >= 0; --pass) step(1 << pass);
  wait(*context_, gl.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

}  // namespace handcast::bench
