// SPDX-License-Identifier: Apache-2.0
// The painters cpu and gl beside each other: the same frames in one run, one hand and two, open and
// folded, at the twin's distance.
//   bench_painters [--frames N] [--size WIDTHxHEIGHT] [--goals FILE]
#include <fmt/format.h>

#include <cstdio>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/draw/gl/gl_painter.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/jump_flood.hpp"
#include "tests/bench/painter_scene.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;

struct Settings {
  int frames = 200, width_px = 1024, height_px = 768;
  std::string goals_file;
};

/// Samples of one figure, µs.
using Samples = std::vector<double>;

/// One painter's wall times of a frame, µs.
struct WallTimes {
  Samples draw, warp, fill, frame;
  FillCounts counts;

  /// Paints one frame in `region`. `warps`: with the pass warp. `reads`: with its image in the
  /// processor's memory.
  void paint(Painter& painter, const PainterScene& scene, const Rect& region, bool warps = false,
             bool reads = true) {
    frame.push_back(timed_us([&] {
      draw.push_back(timed_us([&] { painter.draw(scene.drawn, region); }));
      if (warps) warp.push_back(timed_us([&] { painter.warp(scene.grid, region, region); }));
      fill.push_back(timed_us([&] { counts = painter.fill(scene.mask.view(), {}, region); }));
      if (reads) painter.colour();
    }));
  }
};

/// Everything measured of one scene.
struct SceneTimes {
  WallTimes cpu, gl, gl_without_read, gl_whole_screen, cpu_warped, gl_warped;
  std::array<Samples, gl::kPassNames.size()> passes, warped_passes;
  Samples flood_screen, flood_region;
};

class Bench {
 public:
  explicit Bench(const Settings& settings) : settings_(settings) {}

  /// Opens the painters. Errors: those of open_gl_painter().
  Result<void> open() {
    const auto opened = [&](GlOptions options,
                            std::unique_ptr<GlPainter>& painter) -> Result<void> {
      auto one = open_gl_painter(settings_.width_px, settings_.height_px, options);
      if (!one) return tl::make_unexpected(one.error());
      painter = std::move(*one);
      return {};
    };
    return opened({}, gl_)
        .and_then([&] { return opened({.is_timed = true}, timed_); })
        .and_then([&] { return opened({.reads_back = false}, blind_); });
  }

  const gl::Gpu& gpu() const { return gl_->gpu(); }

  Result<SceneTimes> measure(const PainterScene& scene) {
    auto flood = JumpFlood::create(scene.mask.view());
    if (!flood) return tl::make_unexpected(flood.error());
    for (int i = 0; i < 5; ++i) paint_once(scene, *flood);
    times_ = {};
    for (int i = 0; i < settings_.frames; ++i) paint_once(scene, *flood);
    for (const Painter* painter : {gl_.get(), timed_.get(), blind_.get()})
      if (const auto failure = painter->failure()) return tl::make_unexpected(*failure);
    return times_;
  }

 private:
  void paint_once(const PainterScene& scene, JumpFlood& flood) {
    const Rect screen{0, 0, settings_.width_px, settings_.height_px};
    times_.cpu.paint(*cpu_, scene, scene.region);
    times_.gl.paint(*gl_, scene, scene.region);
    times_.gl_without_read.paint(*blind_, scene, scene.region, false, false);
    times_.gl_whole_screen.paint(*gl_, scene, screen);
    times_.cpu_warped.paint(*cpu_, scene, scene.region, true);
    times_.gl_warped.paint(*gl_, scene, scene.region, true);
    WallTimes unused;
    unused.paint(*timed_, scene, scene.region);
    add(timed_->pass_times(), times_.passes);
    unused.paint(*timed_, scene, scene.region, true);
    add(timed_->pass_times(), times_.warped_passes);
    times_.flood_screen.push_back(timed_us([&] { flood.flood(screen, 10, true); }));
    times_.flood_region.push_back(timed_us([&] { flood.flood(scene.region, 5, true); }));
  }

  static void add(const gl::PassTimes& passes, std::array<Samples, gl::kPassNames.size()>& to) {
    for (std::size_t i = 0; i < passes.size(); ++i) to[i].push_back(passes[i]);
  }

  Settings settings_;
  std::unique_ptr<Painter> cpu_ = make_cpu_painter(settings_.width_px, settings_.height_px);
  std::unique_ptr<GlPainter> gl_, timed_, blind_;
  SceneTimes times_;
};

std::string cell(const Samples* samples) {
  if (samples == nullptr || samples->empty()) return fmt::format("{:>20}", "");
  return fmt::format("{:10.1f}{:10.1f}", median(*samples), percentile(*samples, 0.99));
}

void print_row(std::string_view name, const Samples* cpu, const Samples* gpu, const Samples* wall) {
  fmt::print("  {:<26}{}{}{}\n", name, cell(cpu), cell(gpu), cell(wall));
}

void print_scene(const PainterScene& scene, const SceneTimes& times) {
  using gl::Pass;
  const auto pass = [](const auto& passes, Pass which) {
    return &passes[static_cast<std::size_t>(which)];
  };
  const Rect& r = scene.region;
  fmt::print("\n{}: {} lit + {} filled px, region {}x{}\n", scene.name, times.cpu.counts.lit,
             times.cpu.counts.filled, r.width(), r.height());
  fmt::print("  {:<26}{:>20}{:>20}{:>20}\n  {:<26}", "µs", "cpu", "gl, timer queries", "gl, wall",
             "");
  for (int i = 0; i < 3; ++i) fmt::print("{:>10}{:>10}", "p50", "p99");
  fmt::print("\n");
  print_row("draw", &times.cpu.draw, pass(times.passes, Pass::draw), nullptr);
  print_row("upload of the mask", nullptr, pass(times.passes, Pass::upload), nullptr);
  print_row("fill", &times.cpu.fill, pass(times.passes, Pass::fill), nullptr);
  print_row("read-back", nullptr, pass(times.passes, Pass::read), nullptr);
  print_row("frame without read-back", nullptr, nullptr, &times.gl_without_read.frame);
  print_row("frame", &times.cpu.frame, nullptr, &times.gl.frame);
  print_row("warp", &times.cpu_warped.warp, pass(times.warped_passes, Pass::warp), nullptr);
  print_row("frame with warp", &times.cpu_warped.frame, nullptr, &times.gl_warped.frame);
  print_row("frame, whole screen", nullptr, nullptr, &times.gl_whole_screen.frame);
  print_row("jump flooding, region", nullptr, nullptr, &times.flood_region);
  print_row("jump flooding, screen", nullptr, nullptr, &times.flood_screen);
}

/// Naive: every pass over the whole screen, with jump flooding in 11 passes.
double naive_us(const SceneTimes& times) {
  return median(times.gl_whole_screen.frame) + median(times.flood_screen);
}

void print_gpu(const gl::Gpu& gpu) {
  fmt::print("GL_RENDERER: {}\nGL_VERSION:  {}\nEGL:         {}\n{}\n", gpu.renderer, gpu.version,
             gpu.platform,
             gpu.is_software
                 ? "This is a software renderer: it shows what is right, not what is fast."
                 : "*** This is a hardware GPU. ***");
}

int run(const Settings& settings) {
  Bench bench(settings);
  if (const auto opened = bench.open(); !opened) {
    fmt::print("painter gl cannot be opened: {}\n", opened.error().what);
    return 0;
  }
  print_gpu(bench.gpu());
  fmt::print(
      "{}x{} px, {} frames a scene; jump flooding: 1 + 10 passes on the screen, 1 + 5 on the "
      "region\n",
      settings.width_px, settings.height_px, settings.frames);
  std::vector<Goal> goals;
  for (const auto& [name, hands, pose] : {std::tuple{"one hand, open", 1, renderer::samples::kOpen},
                                          {"one hand, folded", 1, renderer::samples::kFist},
                                          {"two hands, open", 2, renderer::samples::kOpen},
                                          {"two hands, folded", 2, renderer::samples::kFist}}) {
    const PainterScene scene(name, hands, pose, settings.width_px, settings.height_px);
    const auto times = bench.measure(scene);
    if (!times) {
      fmt::print("{}: {}\n", name, times.error().what);
      return 1;
    }
    print_scene(scene, *times);
    goals.push_back({fmt::format("gl, naive whole screen / region, {}", name),
                     naive_us(*times) / median(times->gl.frame), 8, "times", true});
  }
  fmt::print("\n");
  print_goals(goals);
  if (settings.goals_file.empty() || write_goals(settings.goals_file, goals)) return 0;
  fmt::print(stderr, "bench_painters: cannot write '{}'.\n", settings.goals_file);
  return 1;
}

/// Returns false if the words are not understood.
bool parse(int argc, char** argv, Settings& settings) {
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view option = argv[i];
    if (option == "--goals") {
      settings.goals_file = argv[i + 1];
    } else if (option == "--frames") {
      settings.frames = std::atoi(argv[i + 1]);
    } else if (option != "--size" ||
               std::sscanf(argv[i + 1], "%dx%d", &settings.width_px, &settings.height_px) != 2) {
      return false;
    }
  }
  return argc % 2 == 1 && settings.frames > 0 && settings.width_px > 0 && settings.height_px > 0;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Settings settings;
  if (!handcast::bench::parse(argc, argv, settings)) {
    fmt::print(stderr, "usage: bench_painters [--frames N] [--size WIDTHxHEIGHT] [--goals FILE]\n");
    return 2;
  }
  try {
    return handcast::bench::run(settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_painters: {}\n", error.what());
    return 1;
  }
}
