// SPDX-License-Identifier: Apache-2.0
// How far fit_tracker() is off, over synthetic recordings of known truth: the place of the hand,
// the pose, the clock offset, and how often the 95 % intervals hold the truth.
//   bench_calib_tracker [--seeds N] [--seconds S] [--bias-time S] [--points 1|21] [--goals FILE]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/calib/solve/tracker/moving_hand.hpp"

namespace handcast::bench {
namespace {

using calib::samples::World;

constexpr std::array<const char*, 7> kNames{
    "camera's place right, mm",  "camera's place down, mm",  "camera's place forward, mm",
    "rotation about right, deg", "rotation about down, deg", "rotation about forward, deg",
    "clock offset, ms"};

struct Table {
  std::array<std::vector<double>, 7> errors;
  std::array<int, 7> held{};
  std::array<std::vector<double>, 7> sds;
  std::vector<double> middle_mm, expected_mm, rotation_deg, time_ms, held_out_px;
  std::vector<calib::Quality> qualities;
  int fits = 0, failed = 0;
};

const calib::Interval& spread_of(const calib::TrackerFit& fit, std::size_t i) {
  return i < 3 ? fit.camera_place_mm[i] : i < 6 ? fit.rotation_deg[i - 3] : fit.clock_offset_ms;
}

void add(const World& world, Table& table) {
  const auto truth = calib::samples::record(world);
  Result<calib::TrackerFit> fit;
  table.time_ms.push_back(
      timed_us([&] { fit = calib::fit_tracker(truth.camera, truth.samples, truth.sightings); }) /
      1000);
  if (!fit) {
    ++table.failed;
    fmt::print("seed {}: {}\n", world.seed, fit.error().what);
    return;
  }
  ++table.fits;
  table.qualities.push_back(fit->quality);
  const auto errors = calib::samples::errors_of(truth, *fit, world.offset_s);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto& spread = spread_of(*fit, i);
    table.errors[i].push_back(std::abs(errors[i]));
    table.sds[i].push_back(spread.sd);
    table.held[i] += errors[i] >= spread.low && errors[i] <= spread.high;
  }
  table.middle_mm.push_back(calib::samples::error_mm(truth, *fit, calib::samples::kMiddle_m));
  table.expected_mm.push_back(fit->place_errors[0].whole_mm);
  table.rotation_deg.push_back(std::hypot(errors[3], errors[4], errors[5]));
  table.held_out_px.push_back(fit->held_out.median_px);
}

void print(const Table& table) {
  fmt::print("{:32} {:>8} {:>8} {:>12} {:>8}\n", "error", "median", "p95", "expected sd",
             "held, %");
  for (std::size_t i = 0; i < kNames.size(); ++i)
    fmt::print("{:32} {:8.3f} {:8.3f} {:12.3f} {:8.1f}\n", kNames[i], median(table.errors[i]),
               percentile(table.errors[i], 0.95), median(table.sds[i]),
               100.0 * table.held[i] / table.fits);
  fmt::print("{:32} {:8.3f} {:8.3f} {:12.3f}\n", "point in the middle, mm", median(table.middle_mm),
             percentile(table.middle_mm, 0.95), median(table.expected_mm));
  fmt::print("{:32} {:8.3f} {:8.3f}\n", "rotation, deg", median(table.rotation_deg),
             percentile(table.rotation_deg, 0.95));
  fmt::print("{:32} {:8.3f}\n", "held-out residual, px", median(table.held_out_px));
  fmt::print("{:32} {:8.0f} {:8.0f}\n", "time, ms", median(table.time_ms),
             percentile(table.time_ms, 0.95));
  const auto with = [&](calib::Quality quality) {
    return std::ranges::count(table.qualities, quality);
  };
  fmt::print("quality good {}, usable {}, poor {}, no fit {}\n", with(calib::Quality::good),
             with(calib::Quality::usable), with(calib::Quality::poor), table.failed);
}

std::vector<Goal> goals_of(const Table& table) {
  const auto [least, most] = std::ranges::minmax(table.held);
  return {{"median error in the middle of the volume", median(table.middle_mm), 1, "mm"},
          {"median error of the rotation", median(table.rotation_deg), 0.1, "deg"},
          {"p95 of the clock offset", percentile(table.errors[6], 0.95), 1, "ms"},
          {"truth within the 95 % interval, least of 7", 100.0 * least / table.fits, 90, "%", true},
          {"truth within the 95 % interval, most of 7", 100.0 * most / table.fits, 99, "%"}};
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast;
  unsigned seeds = 200;
  calib::samples::World world;
  std::string goals_file;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--seeds") seeds = static_cast<unsigned>(std::atoi(argv[i + 1]));
    if (option == "--seconds") world.seconds = std::atof(argv[i + 1]);
    if (option == "--bias-time") world.bias_time_s = std::atof(argv[i + 1]);
    if (option == "--points") world.only_index_tip = std::atoi(argv[i + 1]) == 1;
    if (option == "--goals") goals_file = argv[i + 1];
  }
  bench::Table table;
  for (world.seed = 1; world.seed <= seeds; ++world.seed) bench::add(world, table);
  bench::print(table);
  const auto goals = bench::goals_of(table);
  bench::print_goals(goals);
  return goals_file.empty() || bench::write_goals(goals_file, goals) ? 0 : 1;
}
