// SPDX-License-Identifier: Apache-2.0
// Where the time of a frame goes on one core: one hand and two, open and folded; how the time grows
// with screen, image and hand; what filtered pictures cost; and the nearest-pixel transform beside
// OpenCV's.
//   bench_frame [--frames N] [--goals FILE]
#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <set>

#include "tests/bench/frame_bandwidth.hpp"
#include "tests/bench/frame_pipeline.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/nearest_against_opencv.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using renderer::samples::kFist;
using renderer::samples::kOpen;

double p50(const FrameTimes& times) { return median(times.frame_us); }
double p99(const FrameTimes& times) { return percentile(times.frame_us, 0.99); }

/// One column per scene, one row per stage.
void print_stages(std::span<const FrameScene> scenes, std::span<const FrameTimes> all) {
  std::set<std::string> stages;
  for (const FrameTimes& times : all)
    for (const auto& [stage, samples] : times.stage_us) stages.insert(stage);
  stages.erase("frame");
  fmt::print("{:<10}", "µs p50/p99");
  for (const FrameScene& scene : scenes) fmt::print(" {:>18}", scene.name);
  const auto row = [&](std::string_view name, auto cell) {
    fmt::print("\n{:<10}", name);
    for (const FrameTimes& times : all) fmt::print(" {:>18}", cell(times));
  };
  row("lit+filled", [](const FrameTimes& times) {
    return fmt::format("{}+{} px", times.lit_px, times.filled_px);
  });
  for (const std::string& stage : stages)
    row(stage, [&](const FrameTimes& times) -> std::string {
      const auto found = times.stage_us.find(stage);
      if (found == times.stage_us.end()) return "";
      return fmt::format("{:.0f}/{:.0f}", median(found->second), percentile(found->second, 0.99));
    });
  row("frame", [](const FrameTimes& times) -> std::string {
    if (!times.error.empty()) return "not measured";
    return fmt::format("{:.0f}/{:.0f}", p50(times), p99(times));
  });
  fmt::print("\n");
  for (const FrameTimes& times : all)
    if (!times.error.empty()) fmt::print("not measured: {}\n", times.error);
}

/// Frames of one hand and two, and the goals for them.
void measure_hands(int frames, std::vector<Goal>& goals) {
  const std::vector<FrameScene> scenes{{.name = "one, open"},
                                       {.name = "one, folded", .pose = kFist},
                                       {.name = "two, open", .hands = 2},
                                       {.name = "two, folded", .hands = 2, .pose = kFist}};
  const auto times = time_frames(scenes, frames);
  fmt::print("hands at 0.73 m\n");
  print_stages(scenes, times);
  for (const auto& [pass, ratio] : print_bandwidth(times[0]))
    goals.push_back({fmt::format("{} / the memory's limit", pass), ratio, 10, "times"});
  const std::array most_p50_ms{0.75, 0.5, 1.3, 1.3}, most_p99_ms{0.95, 0.7, 0., 0.};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (!times[i].error.empty()) continue;
    goals.push_back({fmt::format("cpu frame, {} p50", scenes[i].name), p50(times[i]) / 1000,
                     most_p50_ms[i], "ms"});
    if (most_p99_ms[i] > 0)
      goals.push_back({fmt::format("cpu frame, {} p99", scenes[i].name), p99(times[i]) / 1000,
                       most_p99_ms[i], "ms"});
  }
}

/// What further threads of the painter bring, where cores are free.
void measure_threads(int frames) {
  const std::vector<FrameScene> scenes{{.name = "1 thread"},
                                       {.name = "2 threads", .threads = 2},
                                       {.name = "3 threads", .threads = 3},
                                       {.name = "two hands, 1 thread", .hands = 2},
                                       {.name = "two hands, 2", .hands = 2, .threads = 2}};
  fmt::print("\nprojector.painter_threads\n");
  print_stages(scenes, time_frames(scenes, frames));
}

/// What filtered pictures and shares of pixels cost, in the same run.
void measure_smoothness(int frames) {
  FrameScene paper{.name = "grid warp (paper)"};
  paper.cascade.filter.method = config::FilterMethod::paper;
  paper.cascade.correct.method = config::CorrectMethod::grid;
  const std::vector<FrameScene> scenes{
      {.name = "smooth"}, {.name = "not smooth", .smooth = false}, paper};
  fmt::print("\nwhat content.smooth costs, one open hand\n");
  print_stages(scenes, time_frames(scenes, frames));
}

/// Nothing may grow with the screen or the image when the hand does not.
void measure_growth(int frames, std::vector<Goal>& goals) {
  const std::vector<FrameScene> scenes{
      {.name = "0.8 MP"},
      {.name = "2.1 MP", .screen_width_px = 1920, .screen_height_px = 1080},
      {.name = "8.3 MP", .screen_width_px = 3840, .screen_height_px = 2160},
      {.name = "camera 1.6 MP", .image_width_px = 1440, .image_height_px = 1080},
      {.name = "far, 1.1 m", .distance_m = 1.1},
      {.name = "near, 0.55 m", .distance_m = 0.55}};
  const auto times = time_frames(scenes, frames);
  fmt::print("\nhow the time grows: the screen, the camera's image (0.4 MP), the hand\n");
  print_stages(scenes, times);
  goals.push_back({"frame, screen 8.3 MP / 0.8 MP", p50(times[2]) / p50(times[0]), 1.1, "times"});
  goals.push_back({"frame, camera 1.6 MP / 0.4 MP", p50(times[3]) / p50(times[0]), 1.1, "times"});
}

void print_comparison(const char* title, const NearestComparison& c) {
  fmt::print(
      "nearest pixel, {}: ours {:.0f} µs, OpenCV {:.0f} µs: {:.1f} times; wrong of {}: ours {}, "
      "OpenCV {}\n",
      title, c.ours_us, c.opencv_us, c.opencv_us / c.ours_us, c.wanted, c.wrong_ours,
      c.wrong_opencv);
}

void measure_nearest(std::vector<Goal>& goals) {
  const NearestComparison full = compare_nearest(true, 150), region = compare_nearest(false, 300);
  fmt::print("\n");
  print_comparison("full frame", full);
  print_comparison("region", region);
  goals.push_back({"nearest pixel, OpenCV / ours, full frame", full.opencv_us / full.ours_us, 20,
                   "times", true});
  goals.push_back({"nearest pixel, OpenCV / ours, region", region.opencv_us / region.ours_us, 3,
                   "times", true});
  goals.push_back(
      {"wrong labels", static_cast<double>(full.wrong_ours + region.wrong_ours), 0, "px"});
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  int frames = 3000;
  std::string goals_file;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 < argc && std::strcmp(argv[i], "--frames") == 0) {
      frames = std::atoi(argv[i + 1]);
    } else if (i + 1 < argc && std::strcmp(argv[i], "--goals") == 0) {
      goals_file = argv[i + 1];
    } else {
      fmt::print(stderr, "usage: bench_frame [--frames N] [--goals FILE]\n");
      return 2;
    }
  }
  std::vector<Goal> goals;
  measure_hands(frames, goals);
  measure_threads(frames / 2);
  measure_smoothness(frames / 2);
  measure_growth(frames / 2, goals);
  measure_nearest(goals);
  fmt::print("\n");
  print_goals(goals);
  if (goals_file.empty() || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_frame: cannot write '{}'.\n", goals_file);
  return 1;
}
