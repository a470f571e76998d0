// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handcast::pose {
namespace {

using renderer::kJointParent;

constexpr int kMiddleMetacarpal = 11, kMiddleTip = 15;

glm::dmat3 about_x(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {1, 0, 0, 0, c, s, 0, -s, c};
}
glm::dmat3 about_y(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, 0, -s, 0, 1, 0, s, 0, c};
}

double distance_to_skin_m(const renderer::HandMesh& hand, glm::vec3 joint) {
  float nearest = std::numeric_limits<float>::max();
  for (const glm::vec3& vertex : hand.positions)
    nearest = std::min(nearest, glm::distance(vertex, joint));
  return nearest;
}

}  // namespace

Skeleton::Skeleton(const renderer::HandMesh& hand) {
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::dmat4 rest(hand.rest[j]);
    axes_[j] = glm::dmat3(rest);
    from_palm_m_[j] = glm::dvec3(rest[3]) - glm::dvec3(hand.rest[kPalm][3]);
    radius_m_[j] = distance_to_skin_m(hand, glm::vec3(hand.rest[j][3]));
    const int parent = std::max(kJointParent[j], 0);
    const glm::dmat4 to_parent = glm::inverse(glm::dmat4(hand.rest[parent])) * rest;
    parent_from_joint_[j] = glm::dmat3(to_parent);
    from_parent_m_[j] = glm::dvec3(to_parent[3]);
  }
  for (int j = kMiddleMetacarpal; j <= kMiddleTip; ++j) length_m_ += glm::length(from_parent_m_[j]);
}

PosedHand Skeleton::posed(const Posture& posture, double distance_m) const {
  BoneFactors same;
  for (auto& finger : same) finger.fill(1);
  return posed(posture, distance_m, same);
}

PosedHand Skeleton::posed(const Posture& posture, double distance_m,
                          const BoneFactors& factors) const {
  const glm::dvec3 palm_m(posture.palm_m, distance_m);
  const glm::dmat3 turn = glm::mat3_cast(posture.turn);
  const double size = std::exp(posture.log_size);
  PosedHand hand;
  for (int j = 0; j < msg::kJoints; ++j) {
    hand.place_m[j] = palm_m + turn * (size * from_palm_m_[j]);
    hand.axes[j] = turn * axes_[j];
  }
  for (int f = 0; f < kFingers; ++f) {
    const auto& angle = posture.angle[f];
    for (int k = 0; k < kAngles; ++k) {
      const int joint = kFirstJoint[f] + k, parent = kJointParent[joint];
      hand.place_m[joint] =
          hand.place_m[parent] + hand.axes[parent] * (size * factors[f][k] * from_parent_m_[joint]);
      glm::dmat3 axes = hand.axes[parent] * parent_from_joint_[joint];
      if (k == 0) {
        hand.hinge[f][0] = axes[1];
        axes = axes * about_y(angle[0]);
      }
      if (k + 1 < kAngles) {
        hand.hinge[f][k + 1] = -axes[0];
        axes = axes * about_x(-angle[k + 1]);
      }
      hand.axes[joint] = axes;
    }
  }
  return hand;
}

}  // namespace handcast::pose
