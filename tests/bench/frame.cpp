// SPDX-License-Identifier: Apache-2.0
// Where the time of a frame goes on one core, and the nearest-pixel transform beside OpenCV's.
//   bench_frame [--goals FILE] [Google Benchmark's options]
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstring>
#include <string>
#include <vector>

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "tests/bench/capsule_hand.hpp"
#include "tests/bench/frame_pipeline.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/nearest_against_opencv.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

constexpr renderer::Rect kWholeFrame{0, 0, 1024, 768};

/// One hand drawn and the same hand 12 px further in the mask.
struct PainterScene {
  CapsuleHand hand, moved = shifted();
  renderer::Image<std::uint8_t> mask = silhouette(moved);
  renderer::Rect region = hand.bounds().joined(moved.bounds()).grown(4).within(1024, 768);
  std::unique_ptr<renderer::Painter> painter = renderer::make_cpu_painter(1024, 768);
  renderer::DrawnHand drawn = hand.drawn();

  static CapsuleHand shifted() {
    CapsuleHand hand;
    hand.shift({12, 3});
    return hand;
  }
};

renderer::WarpGrid bent_grid() {
  renderer::WarpGrid grid{21, 21, kWholeFrame, {}};
  for (int row = 0; row < 21; ++row) {
    for (int column = 0; column < 21; ++column) {
      grid.nodes.emplace_back(column * 1023 / 20.f + 3 * std::sin(row + column),
                              row * 767 / 20.f + 2 * std::cos(row - column));
    }
  }
  return grid;
}

void draw(benchmark::State& state) {
  PainterScene scene;
  for (auto _ : state) scene.painter->draw({&scene.drawn, 1}, scene.region);
}
BENCHMARK(draw)->Unit(benchmark::kMicrosecond);

void draw_and_warp(benchmark::State& state) {
  PainterScene scene;
  const renderer::WarpGrid grid = bent_grid();
  for (auto _ : state) {
    scene.painter->draw({&scene.drawn, 1}, scene.region);
    scene.painter->warp(grid, scene.region, scene.region);
  }
}
BENCHMARK(draw_and_warp)->Unit(benchmark::kMicrosecond);

void draw_and_fill(benchmark::State& state) {
  PainterScene scene;
  const config::Fill settings;
  for (auto _ : state) {
    scene.painter->draw({&scene.drawn, 1}, scene.region);
    benchmark::DoNotOptimize(scene.painter->fill(scene.mask.view(), settings, scene.region));
  }
}
BENCHMARK(draw_and_fill)->Unit(benchmark::kMicrosecond);

void print_frame(const char* title, const FrameTimes& times) {
  if (!times.error.empty()) {
    fmt::print("{}: not measured: {}\n", title, times.error);
    return;
  }
  fmt::print("{} ({} lit + {} filled px), µs\n  {:<10} {:>8} {:>8}\n", title, times.lit_px,
             times.filled_px, "", "p50", "p99");
  for (const auto& [stage, samples] : times.stage_us)
    fmt::print("  {:<10} {:8.1f} {:8.1f}\n", stage, median(samples), percentile(samples, 0.99));
  fmt::print("  {:<10} {:8.1f} {:8.1f}\n", "render()", median(times.frame_us),
             percentile(times.frame_us, 0.99));
}

void print_comparison(const char* title, const NearestComparison& c) {
  fmt::print(
      "nearest pixel, {}: ours {:.0f} µs, OpenCV {:.0f} µs: {:.1f} times; wrong of {}: ours {}, "
      "OpenCV {}\n",
      title, c.ours_us, c.opencv_us, c.opencv_us / c.ours_us, c.wanted, c.wrong_ours,
      c.wrong_opencv);
}

std::vector<Goal> measure_goals() {
  config::Cascade ours, paper;
  paper.filter.method = config::FilterMethod::paper;
  paper.correct.method = config::CorrectMethod::grid;
  constexpr double kUsual_m = 0.9, kNear_m = 0.55;
  const FrameTimes frame = time_frames(ours, kUsual_m, 3000);
  print_frame("cpu frame, vertices corrected", frame);
  print_frame("the same, the hand filling the image", time_frames(ours, kNear_m, 1000));
  print_frame("cpu frame, image warped by a grid", time_frames(paper, kUsual_m, 1000));
  const NearestComparison full = compare_nearest(true, 150), region = compare_nearest(false, 300);
  print_comparison("full frame", full);
  print_comparison("region 350x350", region);
  std::vector<Goal> goals;
  if (frame.error.empty())
    goals.push_back({"cpu frame 1024x768 p50", median(frame.frame_us) / 1000, 1.2, "ms"});
  goals.push_back({"nearest pixel, OpenCV / ours, full frame", full.opencv_us / full.ours_us, 20,
                   "times", true});
  goals.push_back({"nearest pixel, OpenCV / ours, region", region.opencv_us / region.ours_us, 3,
                   "times", true});
  goals.push_back(
      {"wrong labels", static_cast<double>(full.wrong_ours + region.wrong_ours), 0, "px"});
  return goals;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  std::string goals_file;
  std::vector<char*> rest{argv[0]};
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--goals") == 0 && i + 1 < argc) {
      goals_file = argv[++i];
    } else {
      rest.push_back(argv[i]);
    }
  }
  auto count = static_cast<int>(rest.size());
  benchmark::Initialize(&count, rest.data());
  if (benchmark::ReportUnrecognizedArguments(count, rest.data())) return 1;
  const std::vector<Goal> goals = measure_goals();
  print_goals(goals);
  if (!goals_file.empty() && !write_goals(goals_file, goals)) {
    fmt::print(stderr, "bench_frame: cannot write '{}'.\n", goals_file);
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
