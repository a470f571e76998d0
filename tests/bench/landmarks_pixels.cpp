// SPDX-License-Identifier: Apache-2.0
// How well the landmarks of cameras are found whose sensors have pixels of other shapes: with the
// lens of the Leap rig, on the twin's images, by one eye without a tracker.
//   bench_landmarks_pixels [RIG.toml] [--set PATH=VALUE]... [--seconds S] [--seed N]
// There are no goals: an argument --goals FILE is accepted and ignored.
#include <fmt/format.h>

#include <cstdlib>

#include "ipc/base/clock.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/seeing_eye.hpp"
#include "tests/bench/stereo_rigs.hpp"

namespace handcast::bench {
namespace {

constexpr std::array kMotions{"show", "rotate", "flip",      "open_close",
                              "fist", "pinch",  "two_hands", "cross_fingers"};

struct Row {
  std::vector<double> px, deg;
  int hands = 0, found = 0;
};

Result<void> add_motion(const char* motion, int rows_per_row, double seconds, config::Rig rig,
                        Row& row) {
  const auto stereo = leap_rig();
  rig.twin.motion = std::string("builtin:") + motion;
  rig.twin.image.gain = stereo.gain;
  rig.landmarks.backend = "handcast";
  rig.pose.backend = "none";
  const auto twin = twin::Twin::create(rig, calib::reference_rig());
  if (!twin) return tl::make_unexpected(twin.error());
  auto eye =
      SeeingEye::open(stereo.calibration, config::Viewpoint::first, rows_per_row, rig, **twin);
  if (!eye) return tl::make_unexpected(eye.error());
  const auto images = static_cast<std::uint64_t>(seconds * stereo.rate_hz);
  for (std::uint64_t k = 0; k < images; ++k) {
    const auto time_ns = seconds_to_ns(static_cast<double>(k + 1) / stereo.rate_hz);
    const auto seen = (*eye)->look(k, time_ns, false);
    if (!seen) return tl::make_unexpected(seen.error());
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      if (!(*twin)->joints(side, time_ns)) continue;
      ++row.hands;
      row.found += seen->find(side) != nullptr;
    }
    for (const auto& miss : (*eye)->compare(*seen)) {
      row.px.push_back(miss.px);
      row.deg.push_back(miss.deg);
    }
  }
  return {};
}

int run(const std::string& file, const std::vector<std::string>& settings, double seconds,
        int seed) {
  auto rig = config::load_rig(file, settings);
  if (!rig) {
    fmt::print(stderr, "{}\n", rig.error().what);
    return 1;
  }
  rig->twin.seed = seed;
  fmt::print("{:<28}{:>21} |{:>24} |{:>8}\n", "sensor", "px: p50, mean, p95", "deg: p50, mean, p95",
             "found %");
  for (const int rows_per_row : {1, 2, 4}) {
    Row row;
    for (const char* motion : kMotions)
      if (auto added = add_motion(motion, rows_per_row, seconds, *rig, row); !added) {
        fmt::print(stderr, "{}\n", added.error().what);
        return 1;
      }
    const auto part = [](const std::vector<double>& v) {
      return std::array{median(v), mean(v), percentile(v, 0.95)};
    };
    const auto px = part(row.px), deg = part(row.deg);
    fmt::print("{:<28}{:7.2f}{:7.2f}{:7.2f} |{:8.3f}{:8.3f}{:8.3f} |{:8.1f}\n",
               fmt::format("640x{}, pixels 1:{}", 480 / rows_per_row, rows_per_row), px[0], px[1],
               px[2], deg[0], deg[1], deg[2], 100.0 * row.found / std::max(row.hands, 1));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  std::string rig = "config/rigs/twin.toml";
  std::vector<std::string> settings;
  double seconds = 4;
  int seed = 11;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_next = i + 1 < argc;
    if (word == "--set" && has_next)
      settings.emplace_back(argv[++i]);
    else if (word == "--seconds" && has_next)
      seconds = std::atof(argv[++i]);
    else if (word == "--seed" && has_next)
      seed = std::atoi(argv[++i]);
    else if (word == "--goals" && has_next)
      ++i;
    else
      rig = word;
  }
  return handcast::bench::run(rig, settings, seconds, seed);
}
