// SPDX-License-Identifier: Apache-2.0
// What the fill does at the seams of the texture, on hands of the twin that turn and bend.
//   bench_frame_seams [--goals FILE] [--pictures DIR]
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/rig.hpp"
#include "renderer/draw/cpu/cpu_painter.hpp"
#include "renderer/media/picture.hpp"
#include "services/lab/simulate/simulation.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/seam_counter.hpp"

namespace handcast::bench {
namespace {

constexpr int kDrawEvery = 40, kFrames = 150, kPictureEvery = 15;
constexpr std::int64_t kFirst_ns = 2'000'000'000;  ///< the hand of the person is learned before

/// Runs a motion and counts. Errors: those of the parts of a rig.
Result<SeamCounts> count_seams(const std::string& motion, const std::string& pictures) {
  const std::vector<std::string> settings{"twin.motion=builtin:" + motion,
                                          "landmarks.backend=twin"};
  const auto rig = config::load_rig("config/rigs/twin.toml", settings);
  if (!rig) return tl::make_unexpected(rig.error());
  const auto calibration = calib::load_calibration(rig->calibration);
  if (!calibration) return tl::make_unexpected(calibration.error());
  const auto twin = twin::Twin::create(*rig, *calibration);
  if (!twin) return tl::make_unexpected(twin.error());
  SeamCounts counts;
  renderer::Texture picture;
  const auto& screen = calibration->projector;
  auto painter = std::make_unique<SeamCounter>(
      renderer::make_cpu_painter(screen.width_px, screen.height_px), counts, picture);
  auto pipeline = renderer::Pipeline::create(rig->cascade, rig->content, rig->hand, *calibration,
                                             {}, std::move(painter));
  if (!pipeline) return tl::make_unexpected(pipeline.error());
  const auto feed = simulate::make_twin_feed(**twin);
  simulate::Simulation simulation(*rig, *calibration, **pipeline, *feed, kDrawEvery);
  for (int frames = 0; frames < kFrames;)
    simulation.step([&](const simulate::Tick& tick) {
      if (!tick.is_new || tick.frame == nullptr) return;
      if (tick.target_ns < kFirst_ns) counts = {};
      if (tick.target_ns < kFirst_ns || ++frames % kPictureEvery != 0 || pictures.empty()) return;
      (void)renderer::write_png(fmt::format("{}/{}-{:03}.png", pictures, motion, frames),
                                std::as_const(picture).view());
    });
  return counts;
}

double percent(long part, const SeamCounts& counts) {
  const long hand = counts.lit + counts.filled;
  return hand > 0 ? 100. * static_cast<double>(part) / static_cast<double>(hand) : 0;
}

void print(std::string_view name, const SeamCounts& counts) {
  fmt::print("  {:<14} {:>10} {:>8.2f} {:>8.3f} {:>8.3f} {:>8.4f} {:>8.4f}\n", name,
             counts.lit + counts.filled, percent(counts.filled, counts),
             percent(counts.beside, counts), percent(counts.seam, counts),
             percent(counts.empty, counts), percent(counts.other, counts));
}

int run(const std::string& goals_file, const std::string& pictures) {
  fmt::print(
      "the fill at the seams of the texture, {} frames of each motion, % of the hand\n"
      "  {:<14} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8}\n",
      kFrames, "", "hand px", "filled", "beside", "stopped", "nothing", "wrong");
  SeamCounts all;
  for (const auto* motion :
       {"flip", "rotate", "turn_fist", "fist", "turn_pointing", "grasp", "coin", "two_hands"}) {
    const auto counts = count_seams(motion, pictures);
    if (!counts) {
      fmt::print("seams: not measured: {}\n", counts.error().what);
      return 0;
    }
    print(motion, *counts);
    all += *counts;
  }
  print("all", all);
  const std::vector<Goal> goals{
      {"fills that show another chart", percent(all.other, all), 0.01, "% of the hand"},
      {"fills that show nothing", percent(all.empty, all), 0.01, "% of the hand"},
      {"fills that a seam stops", percent(all.seam, all), 0.5, "% of the hand"}};
  print_goals(goals);
  return goals_file.empty() || write_goals(goals_file, goals) ? 0 : 1;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  std::string goals, pictures;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string_view(argv[i]) == "--goals") goals = argv[i + 1];
    if (std::string_view(argv[i]) == "--pictures") pictures = argv[i + 1];
  }
  return handcast::bench::run(goals, pictures);
}
