// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/hand_state.hpp"

#include <cmath>

namespace handcast::pose::stereo {
namespace {

/// Calls `visit(unknown, finger, k)` for each angle and, with the other base, each bone.
template <class Visit>
void for_each(int base, Visit&& visit) {
  for (int f = 0; f < kFingers; ++f)
    for (int k = 0; k < kAngles; ++k) visit(base + f * kAngles + k, f, k);
}

}  // namespace

HandState moved(HandState state, const Unknowns& step) {
  const glm::dvec3 by(step[0], step[1], step[2]);
  if (const double angle = glm::length(by); angle > 1e-12)
    state.posture.turn = glm::normalize(glm::angleAxis(angle, by / angle) * state.posture.turn);
  state.posture.palm_m += glm::dvec2(step[kPlaceAt], step[kPlaceAt + 1]);
  state.depth_m += step[kPlaceAt + 2];
  for_each(kAnglesAt, [&](int at, int f, int k) { state.posture.angle[f][k] += step[at]; });
  state.posture.log_size += step[kSizeAt];
  for_each(kBonesAt, [&](int at, int f, int k) { state.log_bone[f][k] += step[at]; });
  return state;
}

Unknowns difference(const HandState& from, const HandState& to) {
  glm::dquat turned = to.posture.turn * glm::conjugate(from.posture.turn);
  if (turned.w < 0) turned = -turned;
  const glm::dvec3 axis(turned.x, turned.y, turned.z);
  const double sine = glm::length(axis);
  const glm::dvec3 by = sine > 1e-12 ? axis * (2 * std::atan2(sine, turned.w) / sine) : axis;
  const glm::dvec2 way_m = to.posture.palm_m - from.posture.palm_m;
  Unknowns step{by.x, by.y, by.z, way_m.x, way_m.y, to.depth_m - from.depth_m};
  for_each(kAnglesAt, [&](int at, int f, int k) {
    step[at] = to.posture.angle[f][k] - from.posture.angle[f][k];
  });
  step[kSizeAt] = to.posture.log_size - from.posture.log_size;
  for_each(kBonesAt,
           [&](int at, int f, int k) { step[at] = to.log_bone[f][k] - from.log_bone[f][k]; });
  return step;
}

PosedHand posed(const Skeleton& skeleton, const HandState& state) {
  BoneFactors factors;
  for (int f = 0; f < kFingers; ++f)
    for (int k = 0; k < kAngles; ++k) factors[f][k] = std::exp(state.log_bone[f][k]);
  return skeleton.posed(state.posture, state.depth_m, factors);
}

}  // namespace handcast::pose::stereo
