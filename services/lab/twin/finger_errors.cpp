// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/finger_errors.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <tuple>

namespace handcast::twin {
namespace {

/// A line of sight is blocked if it passes nearer to a bone than this share of the flesh's radius.
/// @{
constexpr double kBlocked = 0.2, kFree = 1.3;
/// @}
/// Share of a finger's points that are hidden when it begins to be guessed, and when it is.
constexpr double kPartly = 0.1, kMostly = 0.8;
/// Sum of the flexion of a finger's joints when it begins to count as folded, and when it does.
constexpr double kFolding_rad = 2.8, kFolded_rad = 3.6;

/// The points of two lines of finite length that are nearest to each other (Ericson, "Real-Time
/// Collision Detection", 2005, 5.1.9), for a line from the origin.
struct Nearest {
  double along = 0;       ///< on the line from the origin, 0..1
  double distance_m = 0;  ///< between the two
};
Nearest nearest(const glm::dvec3& end, const glm::dvec3& p, const glm::dvec3& q) {
  const glm::dvec3 bone = q - p;
  const double a = glm::dot(end, end), e = glm::dot(bone, bone), b = glm::dot(end, bone),
               c = -glm::dot(end, p), f = -glm::dot(bone, p), square = a * e - b * b;
  double s = square > 1e-15 ? std::clamp((b * f - c * e) / square, 0.0, 1.0) : 0.5;
  const double t = e > 1e-12 ? std::clamp((b * s + f) / e, 0.0, 1.0) : 0;
  s = std::clamp((b * t - c) / a, 0.0, 1.0);
  return {s, glm::distance(end * s, p + bone * t)};
}

glm::dvec3 exact_position(const JointFrames& frames, int joint) {
  return glm::dvec3(frames[joint][3]);
}

/// How far the capsule of a bone blocks the view of a place whose flesh has the radius `own_m`.
/// What touches the place is not before it.
double blocks(const JointFrames& frames, const std::array<float, kJoints>& radii_m, int from,
              int to, const glm::dvec3& seen, double own_m) {
  const auto near = nearest(seen, exact_position(frames, from), exact_position(frames, to));
  const double radius_m = 0.5 * (radii_m[from] + radii_m[to]);
  const double before_m = (1 - near.along) * glm::length(seen);
  return glm::smoothstep(0.6 * (radius_m + own_m), 1.1 * (radius_m + own_m), before_m) *
         (1 - glm::smoothstep(kBlocked * radius_m, kFree * radius_m, near.distance_m));
}

double hidden_share(const JointFrames& frames, const std::array<float, kJoints>& radii_m,
                    int finger) {
  const int pip = bend_joint(finger, bends_of(finger) - 2), dip = pip + 1, tip = dip + 1;
  double hidden = 0;
  for (const auto& [a, b, share] : {std::tuple{pip, dip, 0.0},
                                    {pip, dip, 0.5},
                                    {dip, tip, 0.0},
                                    {dip, tip, 0.5},
                                    {dip, tip, 1.0}})
    hidden += hidden_place(frames, radii_m, finger,
                           glm::mix(exact_position(frames, a), exact_position(frames, b), share),
                           radii_m[b]);
  return hidden / 5;
}

}  // namespace

double hidden_place(const JointFrames& frames, const std::array<float, kJoints>& radii_m,
                    int finger, const glm::dvec3& seen, double radius_m) {
  double hidden = 0;
  for (int f = 0; f < kFingers; ++f) {
    const int root = kMetacarpalJoint[f];
    if (f > 0) hidden = std::max(hidden, blocks(frames, radii_m, root, root + 1, seen, radius_m));
    if (f == finger) continue;
    for (int j = f > 0 ? root + 1 : root; j < tip_joint(f); ++j)
      hidden = std::max(hidden, blocks(frames, radii_m, j, j + 1, seen, radius_m));
  }
  return hidden;
}

std::array<double, kFingers> hidden_fingers(const JointFrames& frames,
                                            const std::array<float, kJoints>& radius_m) {
  const Flexion flexion = flexion_of(frames);
  std::array<double, kFingers> hidden{};
  for (int f = 0; f < kFingers; ++f) {
    const double bend = flexion[f][0] + flexion[f][1] + flexion[f][2];
    const double folded = f == 0 ? 0 : glm::smoothstep(kFolding_rad, kFolded_rad, bend);
    hidden[f] =
        std::max(folded, glm::smoothstep(kPartly, kMostly, hidden_share(frames, radius_m, f)));
  }
  return hidden;
}

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
