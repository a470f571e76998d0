// SPDX-License-Identifier: Apache-2.0
// How well the place of a second camera is determined from views of a board, and whether the 95 %
// intervals say so: with exact lenses, and with lenses that were measured before. Synthetic views
// of known truth; one core.
//   bench_calib_pair [--goals FILE] [--seeds N]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "calib/solve/pair/pair_fit.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/calib/solve/pair/pair_world.hpp"

namespace handcast::bench {
namespace {

using namespace calib;

struct Tally {
  int failures = 0, inside = 0, stated = 0, middle_inside = 0, fits = 0;
  std::array<int, 7> inside_of{};
  std::vector<double> middle_mm, turn_deg, length_mm, held_out_px, held_out_mm, ms;

  double coverage_percent() const { return stated ? 100. * inside / stated : 0; }
};

/// The angle between two rotations.
double off_deg(const glm::dmat4& a, const glm::dmat4& b) {
  const auto off = glm::dmat3(a) * glm::transpose(glm::dmat3(b));
  const glm::dvec3 twice_sine(off[1][2] - off[2][1], off[2][0] - off[0][2], off[0][1] - off[1][0]);
  return glm::degrees(std::asin(std::min(1., glm::length(twice_sine) / 2)));
}

void add(Tally& tally, const PairWorld& world, const KnownLenses& lenses, const PairFit& fit) {
  const auto place_mm = true_place_mm(world);
  const double turn_deg = glm::degrees(std::atan2(0.3, 0.73));
  const std::array truth{place_mm.x, place_mm.y, place_mm.z,           0.,
                         turn_deg,   0.,         glm::length(place_mm)};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& spread = i < 3 ? fit.place_mm[i] : i < 6 ? fit.turn_deg[i - 3] : fit.apart_mm;
    const bool is_inside = truth[i] >= spread.low && truth[i] <= spread.high;
    ++tally.stated;
    tally.inside += is_inside;
    tally.inside_of[i] += is_inside;
  }
  ++tally.fits;
  tally.middle_mm.push_back(middle_off_mm(world, fit));
  tally.middle_inside += tally.middle_mm.back() <= fit.middle_mm;
  tally.length_mm.push_back(length_off_mm(world, fit, lenses));
  tally.turn_deg.push_back(off_deg(fit.second_from_first, world.second_from_first));
  tally.held_out_px.push_back(fit.held_out_px);
  tally.held_out_mm.push_back(fit.held_out_mm);
}

Tally measure(const PairWorld& world, bool with_measured_lenses, int seeds) {
  Tally tally;
  for (unsigned seed = 1; seed <= static_cast<unsigned>(seeds); ++seed) {
    const auto lenses = with_measured_lenses ? measured(world, seed) : exact(world);
    const auto views = show(world, seed);
    Result<PairFit> fit = fail(Errc::bad_data, "no lens");
    tally.ms.push_back(timed_us([&] {
                         if (lenses) fit = fit_pair(views, *lenses);
                       }) /
                       1000);
    if (fit)
      add(tally, world, *lenses, *fit);
    else
      ++tally.failures;
  }
  return tally;
}

void print(const char* name, const Tally& tally) {
  constexpr std::array kNames{"x", "y", "z", "turn x", "turn y", "turn z", "apart"};
  fmt::print(
      "{}: middle of the volume off by {:.2f} mm (95th {:.2f}), turned by {:.3f} deg (95th "
      "{:.3f}); "
      "100 mm there off by {:.2f} (95th {:.2f}); held out {:.2f} px, {:.2f} mm; 95 % intervals "
      "hold {:.1f} %, that of the middle {:.1f} %; "
      "{:.0f} ms; {} failed\n  ",
      name, median(tally.middle_mm), percentile(tally.middle_mm, 0.95), median(tally.turn_deg),
      percentile(tally.turn_deg, 0.95), median(tally.length_mm), percentile(tally.length_mm, 0.95),
      median(tally.held_out_px), median(tally.held_out_mm), tally.coverage_percent(),
      100. * tally.middle_inside / std::max(tally.fits, 1), median(tally.ms), tally.failures);
  for (std::size_t i = 0; i < kNames.size(); ++i)
    fmt::print(" {} {:.1f} %", kNames[i], 100. * tally.inside_of[i] / std::max(tally.fits, 1));
  fmt::print("\n");
}

std::vector<Goal> measure_goals(int seeds) {
  std::vector<Goal> goals;
  for (const bool with_measured_lenses : {false, true}) {
    const auto* name = with_measured_lenses ? "measured lenses" : "exact lenses";
    const auto tally = measure(PairWorld{}, with_measured_lenses, seeds);
    print(name, tally);
    const auto pair = fmt::format("second camera, {}: ", name);
    // A turned camera with another principal point sees nearly the same. So the pose is only as
    // right as the lenses, and what counts is what both make of a thing.
    if (!with_measured_lenses) {
      goals.push_back({pair + "middle of the volume, 95th percentile",
                       percentile(tally.middle_mm, 0.95), 0.5, "mm"});
      goals.push_back(
          {pair + "rotation, 95th percentile", percentile(tally.turn_deg, 0.95), 0.1, "degrees"});
    }
    goals.push_back({pair + "100 mm in the middle, 95th percentile off by",
                     percentile(tally.length_mm, 0.95), 0.5, "mm"});
    goals.push_back({pair + "95 % intervals hold", tally.coverage_percent(), 90, "%", true});
    goals.push_back({pair + "95 % intervals hold", tally.coverage_percent(), 99, "%"});
    goals.push_back({pair + "fits that failed", static_cast<double>(tally.failures), 0, ""});
  }
  return goals;
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  std::string goals_file;
  int seeds = 200;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--goals") == 0) goals_file = argv[i + 1];
    if (std::strcmp(argv[i], "--seeds") == 0) seeds = std::atoi(argv[i + 1]);
  }
  const auto goals = measure_goals(seeds);
  print_goals(goals);
  if (goals_file.empty() || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_calib_pair: cannot write '{}'.\n", goals_file);
  return 1;
}
