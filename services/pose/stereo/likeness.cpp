// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/likeness.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::pose::stereo {
namespace {

/// The correlation in two views of one direction, and the angle between views at which it has
/// fallen to 1/e of that. Measured with handcast's network on the twin: 0.5 to 0.8 at 8 degrees,
/// 0.2 to 0.6 at 22 degrees.
constexpr double kMost = 0.95, kFalls_rad = 0.3;

}  // namespace

Likeness likeness_of(const Views& views, const glm::dvec3& hand_m) {
  const glm::dmat4& second_from_first = views[1].view_from_first;
  const glm::dmat3 turn(second_from_first);
  const glm::dvec3 centre_m = -glm::transpose(turn) * glm::dvec3(second_from_first[3]);
  const double cosine = glm::dot(glm::normalize(hand_m), glm::normalize(hand_m - centre_m));
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double roll = std::atan2(turn[0][1] - turn[1][0], turn[0][0] + turn[1][1]);
  return {kMost * std::exp(-angle / kFalls_rad), std::cos(roll), std::sin(roll)};
}

}  // namespace handcast::pose::stereo
