// SPDX-License-Identifier: Apache-2.0
#include "services/lab/perception/viewer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace handcast::perception {
namespace {

/// Vernier acuity for an edge of good contrast, and the contrast from which on it is that good
/// (Wehrhahn and Westheimer 1990).
constexpr double kVernier_deg = 5.0 / 3600, kGoodContrast = 0.22;
/// The asynchrony to which vernier acuity of fast targets amounts (Carney, Silverstein and Klein
/// 1995).
constexpr double kAsynchrony_s = 1e-3;
/// Exponent of probability summation over places, times and cues (Quick 1974; Watson 1979).
constexpr double kSummation = 4;
/// How many times worse than in those laboratories people are who watch a whole hand. The only
/// constant that was fitted: to 3.08 ms, the mean of ten people without a fill (Casper DPM, Just
/// Noticeable Difference), for the speeds of the authors' recording of all motions.
constexpr double kInattention = 3.06;
/// At this delay, relative to the JND, 75 % of the answers are right: the normal quantile of 0.75.
constexpr double kAtThreshold = 0.674490;

/// The delay that is seen at one place with one cue in a laboratory, s: a shift that is as large as
/// vernier acuity, but never less than the asynchrony. Both grow with the inverse square root of
/// the contrast below a good one (Watt and Morgan 1983).
double seen_s(double speed_deg_s, double contrast) {
  const double weakness = std::sqrt(std::max(1.0, kGoodContrast / contrast));
  return weakness * std::hypot(kAsynchrony_s, kVernier_deg / speed_deg_s);
}

}  // namespace

double degrees_per_s(double speed_m_s) {
  return speed_m_s / kArmsLength_m * 180 / std::numbers::pi;
}

double jnd_ms(std::span<const double> speeds_deg_s, const Cues& cues) {
  double sum = 0;
  for (const double speed : speeds_deg_s) {
    if (!(speed > 0)) continue;
    sum += cues.edges * std::pow(seen_s(speed, 1), -kSummation);
    if (cues.skin_contrast > 0) sum += std::pow(seen_s(speed, cues.skin_contrast), -kSummation);
  }
  if (!(sum > 0)) return std::numeric_limits<double>::infinity();
  const auto count = static_cast<double>(speeds_deg_s.size());
  return 1e3 * kInattention * std::pow(sum / count, -1 / kSummation);
}

double picks_late(double delay_ms, double jnd_ms, double lapse) {
  const double z = kAtThreshold * delay_ms / jnd_ms;
  const double sees = 0.5 * std::erfc(-z / std::numbers::sqrt2);
  return 0.5 * lapse + (1 - lapse) * sees;
}

}  // namespace handcast::perception
