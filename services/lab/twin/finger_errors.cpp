// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/finger_errors.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "services/lab/twin/hidden_fingers.hpp"

namespace handcast::twin {
namespace {

constexpr double kSwitch_s = 0.1;  ///< in which one guess becomes the next
constexpr double kShortestSnap_s = 0.05, kLongestSnap_s = 0.4;
/// Flexion beyond which no tracker reports a joint: its model of the hand has limits.
constexpr double kStraightest_rad = -0.17, kMostBent_rad = 1.9;
/// The DIP follows the PIP by two thirds (Rijpkema and Girard 1991).
constexpr std::array<double, kBends> kShare{1, 1, 2.0 / 3};

std::uint64_t draw_of(renderer::Side side, int finger) {
  return static_cast<std::uint64_t>(side) * kFingers + static_cast<std::uint64_t>(finger);
}

/// A number that is held for `period_s` on average and then becomes another. Normal, of variance 1.
double held(const Random& random, std::uint64_t draw, double seconds, double period_s) {
  const double cell = std::floor(seconds / period_s);
  const auto begins_s = [&](double c) {
    return period_s * (c + 0.5 * random.uniform(2 * draw, static_cast<std::uint64_t>(
                                                              static_cast<std::int64_t>(c))));
  };
  const auto value = [&](double c) {
    return random.normal(2 * draw + 1, static_cast<std::uint64_t>(static_cast<std::int64_t>(c)));
  };
  const double now = seconds < begins_s(cell) ? cell - 1 : cell;
  const double share =
      glm::smoothstep(0.0, 1.0, (seconds - begins_s(now)) / std::min(kSwitch_s, 0.4 * period_s));
  return value(now - 1) + share * (value(now) - value(now - 1));
}

/// `more`, or less of it if the joint would leave the range of fingers.
double within_range(double flexion_rad, double more_rad) {
  return std::clamp(flexion_rad + more_rad, std::min(flexion_rad, kStraightest_rad),
                    std::max(flexion_rad, kMostBent_rad)) -
         flexion_rad;
}

}  // namespace

FingerErrors::FingerErrors(const config::TwinTracker& settings, int seed,
                           const std::array<float, kJoints>& radius_m)
    : settings_(settings),
      radius_m_(radius_m),
      guesses_(seed, Stream::tracker_guess),
      snaps_(seed, Stream::tracker_snap) {}

double FingerErrors::guess_rad(renderer::Side side, int finger, double seconds) const {
  return glm::radians(settings_.hidden_deg) *
         held(guesses_, draw_of(side, finger), seconds, settings_.hidden_s);
}

/// One snap begins in each period of 1 / snap_hz, at a random time in it.
double FingerErrors::snap_rad(renderer::Side side, int finger, double seconds) const {
  if (settings_.snap_hz <= 0) return 0;
  const double period_s = 1 / settings_.snap_hz;
  const auto newest = static_cast<std::int64_t>(std::floor(seconds / period_s));
  const auto oldest = static_cast<std::int64_t>(std::floor((seconds - kLongestSnap_s) / period_s));
  for (std::int64_t i = newest; i >= oldest; --i) {
    const auto draw = static_cast<std::uint64_t>(2 * i) + static_cast<std::uint64_t>(side);
    const double since_s = seconds - period_s * (static_cast<double>(i) + snaps_.uniform(draw, 0));
    const double lasting_s =
        kShortestSnap_s + (kLongestSnap_s - kShortestSnap_s) * snaps_.uniform(draw, 1);
    if (since_s < 0 || since_s >= lasting_s) continue;
    if (static_cast<int>(snaps_.uniform(draw, 2) * kFingers) != finger) continue;
    return glm::radians(snaps_.uniform(draw, 3) < 0.5 ? -settings_.snap_deg : settings_.snap_deg);
  }
  return 0;
}

JointFrames FingerErrors::seen(renderer::Side side, double seconds,
                               const JointFrames& truth) const {
  if (settings_.flexion_bias == 0 && settings_.hidden_deg <= 0 && settings_.snap_hz <= 0)
    return truth;
  const Flexion flexion = flexion_of(truth);
  std::array<double, kFingers> hidden{};
  if (settings_.hidden_deg > 0) hidden = hidden_fingers(truth, radius_m_);
  Flexion more{};
  for (int f = 0; f < kFingers; ++f) {
    double wrong = snap_rad(side, f, seconds);
    if (hidden[f] > 0) wrong += hidden[f] * guess_rad(side, f, seconds);
    for (int i = 0; i < bends_of(f); ++i) {
      const double reported = (1 - settings_.flexion_bias) * flexion[f][i];
      more[f][i] = reported - flexion[f][i] + within_range(reported, wrong * kShare[i]);
    }
  }
  return bent_by(truth, more);
}

}  // namespace handcast::twin
