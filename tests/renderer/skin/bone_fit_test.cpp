// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/bone_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "renderer/skin/skinning.hpp"
#include "tests/renderer/poses.hpp"
#include "tests/services/lab/hand_maker/mesh_checks.hpp"

namespace handcast::renderer {
namespace {

using namespace samples;

constexpr std::int64_t kSample_ns = 9'000'000;
constexpr int kWrist = 1, kIndexBase = 6, kIndexKnuckle = 7, kIndexMiddle = 8, kIndexTip = 10;
constexpr std::array<int, 4> kBases{6, 11, 16, 21};  ///< of the metacarpals, index to little finger

glm::vec3 origin(const JointFrames& frames, int joint) { return glm::vec3(frames[joint][3]); }

void move(JointFrames& frames, int joint, const glm::vec3& by) {
  frames[joint][3] += glm::vec4(by, 0);
}

/// True if a bone starts at this joint. It ends at the next one.
bool begins_bone(int joint) {
  return joint > kWrist && joint + 1 < kJoints && kJointParent[joint + 1] == joint;
}

std::vector<glm::vec3> skinned(const HandMesh& hand, const JointFrames& frames) {
  std::vector<glm::vec3> positions(hand.vertex_count());
  skin(hand, frames, positions);
  return positions;
}

glm::vec3 carried(const HandMesh& hand, const JointFrames& frames, int joint,
                  const glm::vec3& at_rest) {
  return glm::vec3(frames[joint] * glm::inverse(hand.rest[joint]) * glm::vec4(at_rest, 1));
}

float weight_of(const HandMesh& hand, std::size_t v, int joint) {
  float weight = 0;
  for (int k = 0; k < 4; ++k)
    if (hand.joints[v][k] == joint) weight += hand.weights[v][k];
  return weight;
}

/// The largest distance between the positions that the two bones at `joint` give their shared skin.
float step_mm(const HandMesh& hand, const JointFrames& frames, int joint) {
  constexpr float kShared = 0.2f;
  float most = 0;
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    if (weight_of(hand, v, joint - 1) < kShared || weight_of(hand, v, joint) < kShared) continue;
    const glm::vec3 nearer = carried(hand, frames, joint - 1, hand.positions[v]),
                    farther = carried(hand, frames, joint, hand.positions[v]);
    most = std::max(most, 1e3f * glm::distance(nearer, farther));
  }
  return most;
}

float largest_distance_mm(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  float most = 0;
  for (std::size_t v = 0; v < a.size(); ++v) {
    const float distance_mm = 1e3f * glm::distance(a[v], b[v]);
    if (!(distance_mm <= most)) most = distance_mm;  // keeps NaN
  }
  return most;
}

/// The frames with positions scaled about the wrist and orientations kept.
JointFrames grown(JointFrames frames, float factor) {
  for (int joint = 0; joint < kJoints; ++joint)
    frames[joint][3] = glm::vec4(
        origin(frames, kWrist) + factor * (glm::vec3(frames[joint][3]) - origin(frames, kWrist)),
        1);
  return frames;
}

/// The joints of `person`, a left hand; mirrored for Side::right.
JointFrames joints_of(const HandShape& person, Side side) {
  JointFrames frames = rest_frames(person);
  if (side == Side::left) return frames;
  for (auto& frame : frames)
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        if ((column == 0) != (row == 0)) frame[column][row] = -frame[column][row];
  return frames;
}

class BoneFitOf : public ::testing::TestWithParam<Side> {
 protected:
  const HandMesh& hand = mean_hand(GetParam());
  BoneFit fit{hand};

  void learn(const JointFrames& frames, int samples, std::int64_t from_ns = 0) {
    for (int i = 0; i < samples; ++i) fit.learn(from_ns + i * kSample_ns, frames);
  }
  std::vector<glm::vec3> fitted_skin(const JointFrames& frames) const {
    return skinned(hand, fit(frames));
  }
  float moved_mm(const JointFrames& frames) const {
    return largest_distance_mm(fitted_skin(frames), hand.positions);
  }
  bool on_palm(std::size_t v) const {
    float weight = weight_of(hand, v, 0) + weight_of(hand, v, kWrist);
    for (const int base : kBases) weight += weight_of(hand, v, base);
    return weight > 0.999f;
  }
};
INSTANTIATE_TEST_SUITE_P(Sides, BoneFitOf, ::testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "Left" : "Right";
                         });

TEST_P(BoneFitOf, TheMeshsOwnPersonIsSkinnedAsWithoutIt) {
  EXPECT_LT(moved_mm(hand.rest), 1e-3f);
  for (const int samples : {0, 1, 100}) {
    learn(hand.rest, samples);
    for (const Pose& pose : kPoses) {
      const JointFrames frames = posed(hand, pose);
      EXPECT_LT(largest_distance_mm(fitted_skin(frames), skinned(hand, frames)), 2e-3f)
          << pose.name << " after " << samples;
    }
  }
}

TEST_P(BoneFitOf, AHandATenthLargerHasASkinATenthLarger) {
  for (const int samples : {0, 1, 100}) {
    learn(grown(hand.rest, 1.1f), samples);
    for (const Pose& pose : {kOpen, kFist, kPinch}) {
      const JointFrames larger = grown(posed(hand, pose), 1.1f);
      std::vector<glm::vec3> expected = skinned(hand, posed(hand, pose));
      for (glm::vec3& position : expected)
        position = origin(larger, kWrist) + 1.1f * (position - origin(larger, kWrist));
      EXPECT_LT(largest_distance_mm(fitted_skin(larger), expected), 0.01f)
          << pose.name << " after " << samples;
    }
  }
}

TEST_P(BoneFitOf, EveryBoneOfAnotherPersonReachesTheNextJoint) {
  const JointFrames person =
      joints_of(HandShape::mean().scaled({1.2f, 1.1f, 0.9f, 1.15f, 1.05f}, 0.95f, 1), GetParam());
  for (const int samples : {0, 1, 100}) {
    learn(person, samples);
    const JointFrames fitted = fit(person);
    for (int joint = 0; joint < kJoints; ++joint) {
      if (!begins_bone(joint)) continue;
      EXPECT_LT(1e3f * glm::distance(origin(fitted, joint), origin(person, joint)), 1e-2f)
          << kJointNames[joint];
      const glm::vec3 end = carried(hand, fitted, joint, origin(hand.rest, joint + 1));
      EXPECT_LT(1e3f * glm::distance(end, origin(person, joint + 1)), 1e-2f) << kJointNames[joint];
    }
  }
}

TEST_P(BoneFitOf, LongerFingersHaveNoStepsInTheirSkin) {
  const JointFrames person =
      joints_of(HandShape::mean().scaled({1.2f, 1.2f, 1.2f, 1.2f, 1.2f}, 1, 1), GetParam());
  for (int joint = kWrist + 1; joint < kJoints; ++joint) {
    if (!begins_bone(joint - 1) || !begins_bone(joint)) continue;
    // At a knuckle a palm of normal length meets a longer finger.
    const bool knuckle = kJointParent[joint - 1] == kWrist;
    EXPECT_LT(step_mm(hand, fit(person), joint), knuckle ? 2.0f : 0.2f) << kJointNames[joint];
    if (!knuckle) {
      EXPECT_GT(step_mm(hand, person, joint), 3) << kJointNames[joint] << " without the fit";
    }
  }
}

TEST(BoneFit, TheMeanHandComesNearALargerPersonsSkin) {
  const HandMesh& hand = mean_hand(Side::left);
  const HandMesh larger =
      refit_hand(hand, HandShape::mean().scaled({1.08f, 1.12f, 1.1f, 1.12f, 1.06f}, 1.1f, 1.1f));
  const auto mean_distance_mm = [&](const std::vector<glm::vec3>& positions) {
    double sum = 0;
    for (std::size_t v = 0; v < positions.size(); ++v)
      sum += 1e3 * glm::distance(positions[v], larger.positions[v]);
    return sum / static_cast<double>(positions.size());
  };
  const double stiff_mm = mean_distance_mm(skinned(hand, larger.rest));
  const double fitted_mm = mean_distance_mm(skinned(hand, BoneFit(hand)(larger.rest)));
  EXPECT_LT(fitted_mm, 0.5 * stiff_mm);
}

TEST_P(BoneFitOf, ADriftingJointDrawsTheBonesOnBothSidesWithIt) {
  JointFrames drifted = hand.rest;
  move(drifted, kIndexMiddle, {0.006f, 0.002f, 0.001f});
  const JointFrames fitted = fit(drifted);
  const glm::vec3 there = origin(drifted, kIndexMiddle),
                  beyond = origin(hand.rest, kIndexMiddle + 1);
  EXPECT_LT(1e3f * glm::distance(origin(fitted, kIndexMiddle), there), 1e-3f);
  EXPECT_LT(
      1e3f * glm::distance(carried(hand, fitted, kIndexKnuckle, origin(hand.rest, kIndexMiddle)),
                           there),
      1e-2f);
  EXPECT_LT(1e3f * glm::distance(carried(hand, fitted, kIndexMiddle, beyond), beyond), 1e-2f);
  for (const int joint : {kIndexMiddle, kIndexMiddle + 1})
    EXPECT_LT(step_mm(hand, fitted, joint), 0.7f * step_mm(hand, drifted, joint));

  const auto positions = skinned(hand, fitted);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    float on_index = 0;
    for (int joint = kIndexBase; joint <= kIndexTip; ++joint) on_index += weight_of(hand, v, joint);
    if (on_index == 0) {
      ASSERT_LT(1e3f * glm::distance(positions[v], hand.positions[v]), 0.5f) << v;
    }
  }
}

TEST_P(BoneFitOf, ATurnAboutTheBonesOwnAxisIsKept) {
  JointFrames twisted = hand.rest;
  twisted[kIndexMiddle] = twisted[kIndexMiddle] * turn(25, {0, 0, 1});
  const JointFrames fitted = fit(twisted);
  for (int joint = 0; joint < kJoints; ++joint)
    for (int column = 0; column < 4; ++column)
      EXPECT_LT(glm::distance(fitted[joint][column], twisted[joint][column]), 1e-3f) << joint;
}

TEST_P(BoneFitOf, TipsAreLeftAlone) {
  const JointFrames person = grown(posed(hand, kPinch), 1.1f);
  for (const int tip : {5, kIndexTip, 15, 20, 25}) EXPECT_EQ(fit(person)[tip], person[tip]);
}

TEST_P(BoneFitOf, BasesThatTrembleDoNotMoveAPalmThatIsKnown) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.004f);
  const auto trembling = [&] {
    JointFrames frames = hand.rest;
    for (const int base : kBases) move(frames, base, {noise(random), noise(random), noise(random)});
    return frames;
  };
  const auto palm_mm = [&](const BoneFit& of, const JointFrames& frames) {
    const auto positions = skinned(hand, of(frames));
    float most = 0;
    for (std::size_t v = 0; v < positions.size(); ++v)
      if (on_palm(v)) most = std::max(most, 1e3f * glm::distance(positions[v], hand.positions[v]));
    return most;
  };
  for (int i = 0; i < 400; ++i) fit.learn(i * kSample_ns, trembling());
  for (int i = 0; i < 20; ++i) {
    const JointFrames frames = trembling();
    EXPECT_LT(palm_mm(fit, frames), 1) << i;
    EXPECT_GT(palm_mm(BoneFit(hand), frames), 2) << i;
  }
}

TEST_P(BoneFitOf, AKnownPalmBendsWithItsKnuckles) {
  learn(hand.rest, 200);
  JointFrames bent = hand.rest;
  for (const int base : kBases) move(bent, base + 1, {0, -0.004f, 0});
  const JointFrames fitted = fit(bent);
  for (const int base : kBases) {
    const glm::vec3 end = carried(hand, fitted, base, origin(hand.rest, base + 1));
    EXPECT_LT(1e3f * glm::distance(end, origin(bent, base + 1)), 1e-2f) << kJointNames[base];
  }
  EXPECT_LT(1e3f * (origin(fitted, kIndexBase) - origin(hand.rest, kIndexBase)).y, -0.5f)
      << "the bases move part of the distance";
}

TEST_P(BoneFitOf, ARigidMotionMovesTheWholeHand) {
  const glm::mat4 motion = glm::translate(glm::mat4(1), {0.1f, -0.2f, 0.3f}) *
                           turn(70, glm::normalize(glm::vec3(1, 2, 3)));
  const JointFrames person = joints_of(another_person(), GetParam());
  for (const int samples : {0, 1, 50}) {
    learn(person, samples);
    JointFrames moved = person;
    for (glm::mat4& frame : moved) frame = motion * frame;
    std::vector<glm::vec3> expected = fitted_skin(person);
    for (glm::vec3& position : expected) position = glm::vec3(motion * glm::vec4(position, 1));
    EXPECT_LT(largest_distance_mm(fitted_skin(moved), expected), 2e-3f) << samples;
  }
}

TEST_P(BoneFitOf, APersonWhoseHandWasGoneForASecondIsForgotten) {
  const JointFrames next = hand.rest;
  JointFrames first = next, uncertain = next;
  for (const int base : kBases) move(first, base, {-0.005f, 0, 0.006f});
  for (const int base : kBases) move(uncertain, base, {0.003f, 0, 0.004f});
  BoneFit fresh(hand);
  fresh.learn(0, next);

  learn(first, 300, 0);
  const std::int64_t last_ns = 299 * kSample_ns;
  BoneFit soon = fit;
  soon.learn(last_ns + 900'000'000, next);
  EXPECT_GT(largest_distance_mm(skinned(hand, soon(uncertain)), skinned(hand, fresh(uncertain))),
            1);
  fit.learn(last_ns + 1'100'000'000, next);
  EXPECT_EQ(fit(uncertain), fresh(uncertain));
}

TEST_P(BoneFitOf, AfterOneSampleThePalmIsThatSamples) {
  const JointFrames person = joints_of(another_person(), GetParam());
  learn(person, 1);
  EXPECT_LT(largest_distance_mm(fitted_skin(person), skinned(hand, BoneFit(hand)(person))), 2e-3f);
  JointFrames uncertain = person;
  for (const int base : kBases) move(uncertain, base, {0.003f, 0.002f, -0.004f});
  EXPECT_LT(largest_distance_mm(fitted_skin(uncertain), fitted_skin(person)), 1);
}

/// Expects that the frame of a bone scales lengths within the limits.
void expect_sane(const HandMesh& hand, const JointFrames& fitted, int joint) {
  const glm::mat3 whole = glm::mat3(fitted[joint] * glm::inverse(hand.rest[joint]));
  for (const glm::vec3 way : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1),
                              glm::normalize(glm::vec3(1, 1, 1))}) {
    const float factor = glm::length(whole * way);
    EXPECT_GE(factor, 0.49f) << kJointNames[joint];
    EXPECT_LE(factor, 2.01f) << kJointNames[joint];
  }
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_TRUE(std::isfinite(fitted[joint][column][row])) << kJointNames[joint];
}

TEST_P(BoneFitOf, AWildJointBlowsNothingUp) {
  for (const int samples : {0, 1}) {
    learn(hand.rest, samples);
    for (int wild = 0; wild < kJoints; ++wild)
      for (const glm::vec3 by : {glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(0, 0.3f, 1)}) {
        JointFrames frames = hand.rest;
        move(frames, wild, by);
        const JointFrames fitted = fit(frames);
        for (int joint = 0; joint < kJoints; ++joint) expect_sane(hand, fitted, joint);
      }
  }
}

TEST_P(BoneFitOf, ABoneTurnedRightAroundKeepsItsJointsTurn) {
  JointFrames folded = hand.rest;
  const glm::vec3 bone = origin(hand.rest, kIndexMiddle + 1) - origin(hand.rest, kIndexMiddle);
  const glm::vec3 back = glm::mat3(turn(4, {0, 1, 0})) * -bone;
  folded[kIndexMiddle + 1][3] = glm::vec4(origin(folded, kIndexMiddle) + back, 1);
  const JointFrames fitted = fit(folded);
  for (int column = 0; column < 3; ++column)
    EXPECT_GT(glm::dot(glm::normalize(fitted[kIndexMiddle][column]), folded[kIndexMiddle][column]),
              0.999f)
        << column;
}

TEST_P(BoneFitOf, BonesWithoutLengthSurvive) {
  for (const int samples : {0, 1}) {
    learn(hand.rest, samples);
    for (int joint = 0; joint + 1 < kJoints; ++joint) {
      JointFrames frames = hand.rest;
      frames[joint + 1][3] = frames[joint][3];
      const JointFrames fitted = fit(frames);
      for (int each = 0; each < kJoints; ++each) expect_sane(hand, fitted, each);
    }
    JointFrames point = hand.rest;
    for (glm::mat4& frame : point) frame[3] = glm::vec4(0, 0, 0, 1);
    const JointFrames fitted = fit(point);
    for (int each = 0; each < kJoints; ++each) expect_sane(hand, fitted, each);
  }
}

TEST_P(BoneFitOf, APersonLearnedFromAPointIsNoTrouble) {
  JointFrames point = hand.rest;
  for (glm::mat4& frame : point) frame[3] = glm::vec4(0, 0, 0, 1);
  learn(point, 1);
  const JointFrames fitted = fit(hand.rest);
  for (int each = 0; each < kJoints; ++each) expect_sane(hand, fitted, each);
}

TEST_P(BoneFitOf, ASampleThatIsNotANumberTeachesNothing) {
  learn(hand.rest, 5);
  JointFrames broken = hand.rest;
  broken[kIndexBase][3].x = std::numeric_limits<float>::quiet_NaN();
  fit.learn(5 * kSample_ns, broken);
  EXPECT_LT(moved_mm(hand.rest), 1e-3f);
}

}  // namespace
}  // namespace handcast::renderer
