// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/hidden_fingers.hpp"

#include <algorithm>
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

glm::dvec3 place(const JointFrames& frames, int joint) { return glm::dvec3(frames[joint][3]); }

/// How far the capsule of a bone blocks the view of a place whose flesh has the radius `own_m`.
/// What touches the place is not before it.
double blocks(const JointFrames& frames, const std::array<float, kJoints>& radii_m, int from,
              int to, const glm::dvec3& seen, double own_m) {
  const auto near = nearest(seen, place(frames, from), place(frames, to));
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
                           glm::mix(place(frames, a), place(frames, b), share), radii_m[b]);
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

}  // namespace handcast::twin
