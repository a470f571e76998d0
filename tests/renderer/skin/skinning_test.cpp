// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/skinning.hpp"

#include <gtest/gtest.h>

#include "tests/renderer/poses.hpp"
#include "tests/services/lab/hand_maker/mesh_checks.hpp"

namespace handcast::renderer {
namespace {

using namespace samples;

struct Skinned {
  std::vector<glm::vec3> positions, normals;
  Skinned(const HandMesh& hand, const JointFrames& frames)
      : positions(hand.vertex_count()), normals(hand.vertex_count()) {
    skin(hand, frames, positions, normals);
  }
};

TEST(Skinning, RestFramesGiveTheRestHand) {
  const HandMesh& hand = mean_hand(Side::left);
  const Skinned skinned(hand, hand.rest);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    ASSERT_LT(glm::distance(skinned.positions[v], hand.positions[v]), 1e-6f);
    ASSERT_LT(glm::distance(skinned.normals[v], hand.normals[v]), 1e-5f);
  }
}

TEST(Skinning, ARigidMotionOfAllJointsMovesAllOfTheHand) {
  const HandMesh& hand = mean_hand(Side::right);
  const glm::mat4 motion = glm::translate(glm::mat4(1), {0.1f, -0.2f, 0.3f}) *
                           turn(70, glm::normalize(glm::vec3(1, 2, 3)));
  JointFrames frames = hand.rest;
  for (glm::mat4& frame : frames) frame = motion * frame;
  const Skinned skinned(hand, frames);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    ASSERT_LT(
        glm::distance(skinned.positions[v], glm::vec3(motion * glm::vec4(hand.positions[v], 1))),
        1e-6f);
    ASSERT_LT(glm::distance(skinned.normals[v], glm::mat3(motion) * hand.normals[v]), 1e-5f);
  }
}

TEST(Skinning, IsTheWeightedSumOfTheBonesPlaces) {
  const HandMesh& hand = mean_hand(Side::left);
  const JointFrames frames = posed(hand, kFist);
  const Skinned skinned(hand, frames);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    glm::dvec3 expected(0);
    for (int k = 0; k < 4; ++k) {
      const int joint = hand.joints[v][k];
      expected +=
          double(hand.weights[v][k]) *
          glm::dvec3(glm::dmat4(frames[joint]) * glm::inverse(glm::dmat4(hand.rest[joint])) *
                     glm::dvec4(hand.positions[v], 1));
    }
    ASSERT_LT(glm::distance(glm::dvec3(skinned.positions[v]), expected), 1e-6);
  }
}

TEST(Skinning, BendingOneFingerLeavesTheOthersAlone) {
  const HandMesh& hand = mean_hand(Side::left);
  Pose bent = kOpen;
  bent.fingers[0] = {0, 60, 60, 30};
  const Skinned skinned(hand, posed(hand, bent));
  float tip_moved = 0;
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    const float moved = glm::distance(skinned.positions[v], hand.positions[v]);
    const bool middle_to_little = hand.positions[v].z < -0.13f && hand.positions[v].x < 0.02f;
    if (middle_to_little) {
      ASSERT_LT(moved, 1e-6f);
    }
    tip_moved = std::max(tip_moved, moved);
  }
  EXPECT_GT(tip_moved, 0.05f);
}

TEST(Skinning, NormalsStayUnitLength) {
  const HandMesh& hand = mean_hand(Side::left);
  for (const Pose& pose : kPoses)
    for (const glm::vec3& normal : Skinned(hand, posed(hand, pose)).normals)
      ASSERT_NEAR(glm::length(normal), 1, 1e-4);
}

TEST(Skinning, NormalsMayBeLeftOut) {
  const HandMesh& hand = mean_hand(Side::left);
  const Skinned both(hand, posed(hand, kPinch));
  std::vector<glm::vec3> positions(hand.vertex_count());
  skin(hand, posed(hand, kPinch), positions);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    ASSERT_LT(glm::distance(positions[v], both.positions[v]), 1e-6f);
}

}  // namespace
}  // namespace handcast::renderer
