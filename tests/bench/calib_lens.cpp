// SPDX-License-Identifier: Apache-2.0
// How well the lens of a camera is determined from views of a board, and whether the 95 % intervals
// say so. Synthetic views of the paper's camera with known truth; one core.
//   bench_calib_lens [--goals FILE] [--seeds N]
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "calib/solve/lens/lens_fit.hpp"
#include "tests/bench/goals.hpp"
#include "tests/calib/solve/lens/synthetic_views.hpp"

namespace handcast::bench {
namespace {

using namespace calib;

struct Lens {
  const char* name;
  CameraModel camera;
};

std::vector<Lens> lenses() {
  CameraModel mild;
  mild.k1 = -0.1, mild.cx_px = 352, mild.cy_px = 275;
  auto usual = mild;
  usual.k1 = -0.28, usual.k2 = 0.15;
  return {{"k1", mild}, {"k1 k2", usual}, {"the paper's", reference_rig().camera}};
}

std::array<double, 9> values_of(const CameraModel& c) {
  return {c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
}

/// Of a model that lacks coefficients of the lens, the other coefficients make up for them: their
/// intervals are for what they then are, not for the truth.
constexpr std::size_t kFirstCoefficient = 4;

struct Tally {
  int failures = 0;
  std::array<int, 5> chosen{};
  std::array<int, 9> inside{}, stated{};
  std::vector<double> fx_percent, reprojection_px, held_out_px;
  double ms = 0;

  double coverage_percent() const {
    int in = 0, all = 0;
    for (std::size_t i = 0; i < inside.size(); ++i) in += inside[i], all += stated[i];
    return all ? 100. * in / all : 0;
  }
};

void add(Tally& tally, const LensFit& fit, const CameraModel& truth) {
  ++tally.chosen[static_cast<std::size_t>(fit.distortion)];
  const auto true_values = values_of(truth);
  bool complete = true;  // the model has all coefficients of the lens
  for (std::size_t i = 0; i < true_values.size(); ++i)
    complete = complete && (fit.spreads[i].deviation > 0 || true_values[i] == 0);
  for (std::size_t i = 0; i < true_values.size(); ++i) {
    const auto& spread = fit.spreads[i];
    if (spread.deviation == 0 || (i >= kFirstCoefficient && !complete)) continue;
    ++tally.stated[i];
    tally.inside[i] += true_values[i] >= spread.low && true_values[i] <= spread.high;
  }
  tally.fx_percent.push_back(100 * std::abs(fit.camera.fx_px / truth.fx_px - 1));
  tally.reprojection_px.push_back(reprojection_px(fit.camera, truth));
  tally.held_out_px.push_back(fit.held_out_px);
}

Tally measure(const Lens& lens, int views, int seeds) {
  using namespace std::chrono;
  Tally tally;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto shown = show({.views = views}, lens.camera, static_cast<unsigned>(seed));
    const auto begin = steady_clock::now();
    const auto fit = fit_lens(shown, lens.camera.width_px, lens.camera.height_px);
    tally.ms += duration<double, std::milli>(steady_clock::now() - begin).count() / seeds;
    if (fit)
      add(tally, *fit, lens.camera);
    else
      ++tally.failures;
  }
  return tally;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const Lens& lens, int views, const Tally& tally) {
  fmt::print(
      "{:<12} {:>2} views: fx off by {:.3f} % (95th {:.3f}); to the truth {:.3f} px (95th {:.3f}); "
      "held out {:.3f} px; 95 % intervals hold {:.1f} %; {:.0f} ms; {} failed\n",
      lens.name, views, quantile(tally.fx_percent, 0.5), quantile(tally.fx_percent, 0.95),
      quantile(tally.reprojection_px, 0.5), quantile(tally.reprojection_px, 0.95),
      quantile(tally.held_out_px, 0.5), tally.coverage_percent(), tally.ms, tally.failures);
  fmt::print("  ");
  for (std::size_t i = 0; i < tally.stated.size(); ++i)
    if (tally.stated[i])
      fmt::print(" {} {:.1f} %", kLensParameters[i], 100. * tally.inside[i] / tally.stated[i]);
  fmt::print("; chosen");
  for (std::size_t i = 0; i < tally.chosen.size(); ++i)
    if (tally.chosen[i]) fmt::print(" {} {}x", words_of(Distortion{})[i], tally.chosen[i]);
  fmt::print("\n");
}

std::vector<Goal> measure_goals(int seeds) {
  std::vector<Goal> goals;
  for (const auto& lens : lenses())
    for (const int views : {8, 15}) {
      const auto tally = measure(lens, views, seeds);
      print(lens, views, tally);
      if (views != 15) continue;
      const auto name = fmt::format("lens {}: ", lens.name);
      goals.push_back({name + "fx, 95th percentile", quantile(tally.fx_percent, 0.95), 0.3, "%"});
      goals.push_back(
          {name + "to the truth, median", quantile(tally.reprojection_px, 0.5), 0.3, "px"});
      goals.push_back({name + "95 % intervals hold", tally.coverage_percent(), 90, "%", true});
      goals.push_back({name + "95 % intervals hold", tally.coverage_percent(), 99, "%"});
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
  const std::vector<Goal> goals = measure_goals(seeds);
  print_goals(goals);
  if (goals_file.empty() || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_calib_lens: cannot write '{}'.\n", goals_file);
  return 1;
}
