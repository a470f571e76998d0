// SPDX-License-Identifier: Apache-2.0
// A frame of the painter gl on its way to a window: from the GPU, and through memory. Needs an X
// server ($DISPLAY).
//   bench_painters_window [--frames N]
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "renderer/draw/gl/gl_painter.hpp"
#include "renderer/window/window.hpp"
#include "tests/bench/painter_scene.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;

constexpr int kWidth = 1024, kHeight = 768;

struct Times {
  std::vector<double> from_gpu_us, through_memory_us;
};

/// From the beginning of a frame until the window system has it.
Result<Times> measure(Window& window, GlPainter& painter, const PainterScene& scene, int frames) {
  const LightTable table = light_table({});
  Texture picture(kWidth, kHeight);
  Times times;
  for (int i = 0; i < frames; ++i) {
    Result<Shown> shown;
    times.from_gpu_us.push_back(timed_us([&] {
      painter.draw(scene.drawn, scene.region);
      painter.fill(scene.mask.view(), {}, scene.region);
      if (const auto image = painter.device_image())
        shown = window.show(*image, scene.region, table);
      else
        shown = fail(Errc::unavailable, "the painter has no image for the window");
    }));
    if (!shown) return tl::make_unexpected(shown.error());
    times.through_memory_us.push_back(timed_us([&] {
      painter.draw(scene.drawn, scene.region);
      painter.fill(scene.mask.view(), {}, scene.region);
      write_light(painter.colour(), scene.region, table, picture.view());
      shown = window.show(picture.view(), scene.region);
    }));
    if (!shown) return tl::make_unexpected(shown.error());
  }
  return times;
}

Result<void> run(int frames) {
  auto window = Window::open(
      {.title = "bench", .width_px = kWidth, .height_px = kHeight, .monitor = {}, .vsync = false});
  if (!window) return tl::make_unexpected(window.error());
  auto painter = open_gl_painter(kWidth, kHeight, {.shares = (*window)->share_group()});
  if (!painter) return tl::make_unexpected(painter.error());
  fmt::print("{}\n{:<18} {:>16} {:>8} {:>16} {:>8}\n", (*painter)->gpu().sentence(),
             "µs until shown", "from the GPU p50", "p99", "by memory p50", "p99");
  for (const auto& [name, hands] : {std::pair{"one hand", 1}, {"two hands", 2}}) {
    const PainterScene scene(name, hands, samples::kOpen, kWidth, kHeight);
    const auto times = measure(**window, **painter, scene, frames);
    if (!times) return tl::make_unexpected(times.error());
    fmt::print("{:<18} {:>16.0f} {:>8.0f} {:>16.0f} {:>8.0f}\n", name, median(times->from_gpu_us),
               percentile(times->from_gpu_us, 0.99), median(times->through_memory_us),
               percentile(times->through_memory_us, 0.99));
  }
  return {};
}

}  // namespace
}  // namespace handcast::bench

/// There are no goals: an argument --goals FILE is accepted and ignored. Without an X server
/// nothing is measured, which is no failure.
int main(int argc, char** argv) {
  int frames = 300;
  for (int i = 1; i + 1 < argc; i += 2)
    if (std::string_view(argv[i]) == "--frames") frames = std::max(10, std::atoi(argv[i + 1]));
  const auto done = handcast::bench::run(frames);
  if (!done) fmt::print("bench_painters_window: not measured: {}\n", done.error().what);
  return 0;
}
