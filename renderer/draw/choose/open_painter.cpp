// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/choose/open_painter.hpp"

#include "ipc/base/log.hpp"
#include "renderer/draw/choose/contest.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#ifdef HANDCAST_WITH_GL
#include "renderer/draw/gl/gl_painter.hpp"
#endif

namespace handcast::renderer {
namespace {

/// A painter on a GPU, and what the log calls that GPU.
struct OpenedGl {
  std::unique_ptr<Painter> painter;
  std::string gpu;
};

Result<OpenedGl> open_gl([[maybe_unused]] int width_px, [[maybe_unused]] int height_px,
                         [[maybe_unused]] const ShareGroup& shares) {
#ifdef HANDCAST_WITH_GL
  auto painter = open_gl_painter(width_px, height_px, {.is_timed = true, .shares = shares});
  if (!painter && shares) {
    log::warning("painter gl cannot draw for the window: {}; its images are copied instead",
                 painter.error().what);
    painter = open_gl_painter(width_px, height_px, {.is_timed = true});
  }
  if (!painter) return tl::make_unexpected(painter.error());
  const gl::Gpu& gpu = (*painter)->gpu();
  std::string name = fmt::format("{} (EGL {})", gpu.sentence(), gpu.platform);
  return OpenedGl{std::move(*painter), std::move(name)};
#else
  return fail(Errc::bad_config, "this handcast was built without it (HANDCAST_WITH_GL)");
#endif
}

/// The faster of two painters.
std::unique_ptr<Painter> faster_of(std::unique_ptr<Painter> cpu, OpenedGl gl, int width_px,
                                   int height_px) {
  constexpr double kSeconds = 1;
  const auto [cpu_times, gl_times] = contest(*cpu, *gl.painter, width_px, height_px, kSeconds);
  if (const auto failure = gl.painter->failure()) {
    log::warning("{}; drawing with cpu", failure->what);
    return cpu;
  }
  const bool gl_wins = gl_times.p50_ms < cpu_times.p50_ms;
  log::info(
      "painter auto: {} is faster: a frame takes {:.2f} ms (p99 {:.2f}) with cpu, {:.2f} ms (p99 "
      "{:.2f}) with gl on {}",
      gl_wins ? "gl" : "cpu", cpu_times.p50_ms, cpu_times.p99_ms, gl_times.p50_ms, gl_times.p99_ms,
      gl.gpu);
  return gl_wins ? std::move(gl.painter) : std::move(cpu);
}

}  // namespace

std::unique_ptr<Painter> open_painter(config::PainterChoice choice, int width_px, int height_px,
                                      const ShareGroup& shares) {
  if (choice == config::PainterChoice::cpu) return make_cpu_painter(width_px, height_px);
  auto gl = open_gl(width_px, height_px, shares);
  if (!gl) {
    log::warning("painter gl cannot be opened: {}; drawing with cpu", gl.error().what);
    return make_cpu_painter(width_px, height_px);
  }
  if (choice == config::PainterChoice::automatic)
    return faster_of(make_cpu_painter(width_px, height_px), std::move(*gl), width_px, height_px);
  log::info("painter gl: {}", gl->gpu);
  return std::move(gl->painter);
}

}  // namespace handcast::renderer
