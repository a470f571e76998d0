// SPDX-License-Identifier: Apache-2.0
#include "tests/services/pose/openxr/runtime/tracker.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::test_runtime {
namespace {

using Pose = std::optional<msg::HandPose>;

/// A number from -1 to 1 that depends on all its arguments.
float noise(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t x = a * 0x9e3779b97f4a7c15u + b * 0xc2b2ae3d27d4eb4fu + c * 0x165667b19e3779f9u;
  for (int round = 0; round < 2; ++round) x = (x ^ (x >> 29)) * 0xbf58476d1ce4e5b9u;
  return static_cast<float>(static_cast<double>(x >> 11) / 4503599627370496.0 - 1);
}

/// a + share * (b - a), for any share.
msg::HandPose mixed(const msg::HandPose& a, const msg::HandPose& b, float share) {
  msg::HandPose pose = a;
  for (std::size_t j = 0; j < msg::kJoints; ++j) {
    const auto &from = a.joints[j], &to = b.joints[j];
    auto& joint = pose.joints[j];
    float dot = 0, length2 = 0;
    for (int i = 0; i < 4; ++i) dot += from.orientation_xyzw[i] * to.orientation_xyzw[i];
    for (int i = 0; i < 3; ++i)
      joint.position_m[i] += share * (to.position_m[i] - from.position_m[i]);
    for (int i = 0; i < 4; ++i) {
      const float end = dot < 0 ? -to.orientation_xyzw[i] : to.orientation_xyzw[i];
      joint.orientation_xyzw[i] += share * (end - from.orientation_xyzw[i]);
      length2 += joint.orientation_xyzw[i] * joint.orientation_xyzw[i];
    }
    for (float& part : joint.orientation_xyzw) part /= std::sqrt(length2);
  }
  return pose;
}

Pose mixed(const Pose& a, const Pose& b, double share) {
  if (!a || !b) return a ? a : b;
  return mixed(*a, *b, static_cast<float>(share));
}

}  // namespace

Motion swaying_hand() {
  constexpr double kTau = 6.283185307179586;
  Motion motion{500, {}};
  for (int k = 0; k < 1500; ++k) {
    msg::HandPoses poses;
    poses.count = 1;
    for (int j = 0; j < msg::kJoints; ++j) {
      const int finger = j < 2 ? 0 : std::min((j - 1) / 5, 4), along = j < 2 ? 0 : (j - 1) % 5;
      const double sway = 0.05 * std::sin(kTau * k / 750);
      poses.hands[0].joints[j].position_m = {static_cast<float>(0.02 * finger + sway),
                                             static_cast<float>(0.2 + 0.01 * finger),
                                             static_cast<float>(-0.03 * along)};
      poses.hands[0].joints[j].radius_m = 0.008f;
    }
    motion.frames.push_back(poses);
  }
  return motion;
}

Pose Tracker::truth(msg::Side side, double time_s) const {
  const auto count = static_cast<std::int64_t>(motion_.frames.size());
  const double place = time_s * motion_.rate_hz, whole = std::floor(place);
  const auto at = [&](std::int64_t k) -> Pose {
    const auto* pose =
        motion_.frames[static_cast<std::size_t>(((k % count) + count) % count)].find(side);
    return pose ? Pose(*pose) : std::nullopt;
  };
  const auto k = static_cast<std::int64_t>(whole);
  return mixed(at(k), at(k + 1), place - whole);
}

Pose Tracker::sample(const Script& script, msg::Side side, std::int64_t k) const {
  auto pose = truth(side, static_cast<double>(k) / script.rate_hz);
  if (!pose) return pose;
  for (std::size_t j = 0; j < msg::kJoints; ++j)
    for (std::size_t i = 0; i < 3; ++i)
      pose->joints[j].position_m[i] +=
          static_cast<float>(1e-3 * script.noise_mm) * noise(static_cast<std::uint64_t>(k), j, i);
  return pose;
}

Pose Tracker::between(const Script& script, msg::Side side, double place) const {
  const auto k = static_cast<std::int64_t>(std::floor(place));
  return mixed(sample(script, side, k), sample(script, side, k + 1),
               place - static_cast<double>(k));
}

Pose Tracker::hand(const Script& script, msg::Side side, std::int64_t time_ns,
                   std::int64_t now_ns) const {
  const double place = 1e-9 * static_cast<double>(time_ns) * script.rate_hz;
  const double arrived =
      (1e-9 * static_cast<double>(now_ns) - 1e-3 * script.age_ms) * script.rate_hz;
  const auto newest = static_cast<std::int64_t>(std::floor(arrived));
  const double ahead = place - static_cast<double>(newest);
  const auto from_newest = [&](std::int64_t back) { return sample(script, side, newest - back); };
  if (script.times == Times::knows) {
    auto pose = truth(side, 1e-9 * static_cast<double>(time_ns));
    if (pose)
      pose->joints[0].position_m[0] += 1e-6f * noise(static_cast<std::uint64_t>(time_ns), 0, 0);
    return pose;
  }
  if (script.times == Times::holds) return from_newest(0);
  if (ahead <= 0) return between(script, side, place);
  switch (script.times) {
    case Times::predicts: {
      // Through the means of the older and of the newer two of four samples.
      const auto older = mixed(from_newest(3), from_newest(2), 0.5);
      const auto newer = mixed(from_newest(1), from_newest(0), 0.5);
      return mixed(older, newer, (ahead + 2.5) / 2);
    }
    case Times::overshoots:
      return mixed(from_newest(1), from_newest(0), 1 + 2 * ahead);
    default:
      return from_newest(0);
  }
}

}  // namespace handcast::test_runtime
