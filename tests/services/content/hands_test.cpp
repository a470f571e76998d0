// SPDX-License-Identifier: Apache-2.0
#include "services/content/hands.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "services/lab/twin/articulation.hpp"
#include "services/lab/twin/gestures.hpp"
#include "tests/services/content/gesturing_hands.hpp"

namespace handcast::content {
namespace {

constexpr glm::vec3 kDown{0, 1, 0};

/// A hand held up in front of the camera, its back to it.
HandState bent(Side side, const twin::Bend& bend, double size = 1, double turn = 0) {
  auto shape = renderer::HandShape::mean();
  shape =
      shape.scaled({static_cast<float>(size), static_cast<float>(size), static_cast<float>(size),
                    static_cast<float>(size), static_cast<float>(size)},
                   static_cast<float>(size), static_cast<float>(size));
  const glm::dmat4 held{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0.7, 1}};
  const auto frames =
      twin::Articulation(shape).frames(side, glm::rotate(held, turn, glm::dvec3(0, 0, 1)), bend);
  HandState hand;
  hand.side = side;
  for (std::size_t joint = 0; joint < kJoints; ++joint)
    hand.joints_m[joint] = glm::vec3(frames[joint][3]);
  derive(hand, kDown);
  return hand;
}

twin::Bend open(double splay) {
  twin::Bend bend;
  for (std::size_t f = 1; f < 5; ++f) bend.splay[f] = (2.4 - static_cast<double>(f)) * splay;
  return bend;
}
twin::Bend fist(double amount = 1.05) {
  twin::Bend bend;
  for (int f = 1; f < 5; ++f) twin::curl(bend, f, amount);
  twin::close_thumb(bend, amount);
  return bend;
}
/// At 1 the tips of the thumb and the index finger of the mean hand meet.
twin::Bend pinch(double amount) {
  twin::Bend bend;
  bend.flexion[1] = {0.75 * amount, 0.80 * amount, 0.35 * amount};
  bend.flexion[0] = {0.25 * amount, 0.35 * amount, 0};
  bend.thumb_opposition = 0.1 * amount;
  bend.thumb_flexion = 0.2 * amount;
  return bend;
}

class HandValues : public testing::TestWithParam<Side> {};
INSTANTIATE_TEST_SUITE_P(Sides, HandValues, testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "Left" : "Right";
                         });

TEST_P(HandValues, AnOpenHandIsFlatAndDoesNotPinch) {
  const auto hand = bent(GetParam(), open(0.12));
  EXPECT_LT(hand.curl, 0.05f);
  EXPECT_LT(hand.pinch, 0.1f);
  EXPECT_GT(hand.spread, 0.9f);
}

TEST_P(HandValues, FingersSideBySideAreNotSpread) {
  EXPECT_LT(bent(GetParam(), open(-0.07)).spread, 0.1f);
  EXPECT_GT(bent(GetParam(), open(0.07)).spread, bent(GetParam(), open(0)).spread + 0.1f);
}

TEST_P(HandValues, AFistIsCurledAndNotSpread) {
  const auto hand = bent(GetParam(), fist());
  EXPECT_GT(hand.curl, 0.95f);
  EXPECT_LT(hand.spread, 0.1f);
}

TEST_P(HandValues, TheTipsOfThumbAndIndexFingerPinch) {
  const auto hand = bent(GetParam(), pinch(1));
  EXPECT_GT(hand.pinch, 0.95f);
  EXPECT_LT(hand.curl, 0.5f);
}

TEST_P(HandValues, ValuesAreSmoothAndRiseWithTheMovement) {
  for (int k = 1; k <= 100; ++k) {
    const auto before = bent(GetParam(), pinch((k - 1) * 0.01)),
               after = bent(GetParam(), pinch(k * 0.01));
    EXPECT_GE(after.pinch, before.pinch - 1e-3f);
    EXPECT_LT(after.pinch, before.pinch + 0.05f);
    const auto opener = bent(GetParam(), fist((k - 1) * 0.01)),
               closer = bent(GetParam(), fist(k * 0.01));
    EXPECT_GE(closer.curl, opener.curl - 1e-3f);
    EXPECT_LT(closer.curl, opener.curl + 0.05f);
  }
}

TEST_P(HandValues, AreTheSameForHandsOfAnySize) {
  for (const auto& bend : {open(0.1), pinch(0.6), fist(0.5)}) {
    const auto child = bent(GetParam(), bend, 0.7), giant = bent(GetParam(), bend, 1.3);
    EXPECT_NEAR(child.pinch, giant.pinch, 0.02f);
    EXPECT_NEAR(child.spread, giant.spread, 0.02f);
    EXPECT_NEAR(child.curl, giant.curl, 0.02f);
  }
}

TEST_P(HandValues, ThePalmLooksAwayFromACameraThatSeesTheBack) {
  const auto hand = bent(GetParam(), open(0));
  EXPECT_GT(hand.palm_normal.z, 0.95f);
  EXPECT_GT(hand.gravity.z, 0.95f) << "the arm is below";
  // Turned over about the forearm.
  EXPECT_LT(bent(GetParam(), open(0), 1, std::numbers::pi).palm_normal.z, -0.95f);
}

TEST_P(HandValues, GravityIsInTheAxesOfTheHand) {
  auto hand = bent(GetParam(), open(0));
  derive(hand, {1, 0, 0});
  EXPECT_GT(hand.gravity.x, 0.95f) << "the thumb of the left hand, the little finger of the right";
  derive(hand, {0, 0, -3});
  EXPECT_GT(hand.gravity.y, 0.95f) << "out of the back";
  EXPECT_NEAR(glm::length(hand.gravity), 1, 1e-3f);
}

TEST_P(HandValues, JointsInOnePlaceGiveFiniteValues) {
  HandState hand;
  hand.side = GetParam();
  derive(hand, kDown);
  for (const float value : {hand.pinch, hand.spread, hand.curl, hand.gravity.x, hand.palm_normal.z})
    EXPECT_TRUE(std::isfinite(value));
}

class HandsTest : public testing::Test {
 protected:
  static constexpr auto ns = GesturingHands::ns;
  GesturingHands tracked{"two_hands"};
  Hands hands = *Hands::load({}, tracked.calibration());
};

TEST_F(HandsTest, WithoutASampleBothHandsAreHeldUpAtRest) {
  const auto both = hands.at(ns(1));
  for (const auto& hand : both) {
    EXPECT_FALSE(hand.is_there);
    EXPECT_NE(hand.mesh, nullptr);
    EXPECT_TRUE(hand.positions_m.empty());
    EXPECT_GT(hand.palm_normal.z, 0.9f);
    EXPECT_LT(hand.joints_m[10].y, hand.joints_m[1].y) << "the tips are above the wrist";
  }
  EXPECT_EQ(both[0].side, Side::left);
  EXPECT_EQ(both[1].side, Side::right);
}

TEST_F(HandsTest, AreInCameraSpaceAtTheTimeOfTheLight) {
  tracked.follow(hands, 2);
  const auto both = hands.at(ns(2.02));
  for (const auto& hand : both) {
    ASSERT_TRUE(hand.is_there);
    const auto truth = *tracked.pose(hand.side, 2.02);
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      const auto& at = truth.joints[joint].position_m;
      const glm::dvec3 there(tracked.calibration().camera_from_tracker *
                             glm::dvec4(at[0], at[1], at[2], 1));
      EXPECT_LT(glm::distance(glm::vec3(there), hand.joints_m[joint]), 2e-3f) << joint;
    }
  }
}

TEST_F(HandsTest, AHandThatIsNotSampledFor200MsIsNotThere) {
  tracked.follow(hands, 2);
  EXPECT_TRUE(hands.at(ns(2.19))[0].is_there);
  EXPECT_FALSE(hands.at(ns(2.21))[0].is_there);
}

TEST_F(HandsTest, AHandThatTheTrackerDoesNotBelieveInIsNotThere) {
  auto poses = tracked.sample(2);
  poses.hands[0].confidence = 0.05f;
  hands.push(poses);
  EXPECT_FALSE(hands.at(ns(2))[0].is_there);
  EXPECT_TRUE(hands.at(ns(2))[1].is_there);
}

TEST_F(HandsTest, ASampleFromTheFutureIsIgnored) {
  auto poses = tracked.sample(2);
  poses.header.published_ns = ns(1.9);
  hands.push(poses);
  EXPECT_FALSE(hands.at(ns(2))[0].is_there);
}

TEST_F(HandsTest, HaveTheVelocityOfThePalm) {
  const GesturingHands shaking("shake");
  shaking.follow(hands, 2);
  const auto moved = [&](double seconds) {
    const auto pose = *shaking.pose(Side::left, seconds);
    const auto& at = pose.joints[0].position_m;
    return glm::mat3(shaking.calibration().camera_from_tracker) * glm::vec3(at[0], at[1], at[2]);
  };
  const glm::vec3 truth = (moved(2) - moved(1.95)) / 0.05f;
  EXPECT_GT(glm::length(truth), 0.1f);
  EXPECT_LT(glm::distance(hands.at(ns(2))[0].velocity_m_s, truth), 0.05f);
}

TEST_F(HandsTest, ASurfaceIsSkinnedOnlyIfItIsNeeded) {
  tracked.follow(hands, 2);
  EXPECT_TRUE(hands.at(ns(2))[0].positions_m.empty());
  hands.needs_surface(true);
  const auto both = hands.at(ns(2));
  for (const auto& hand : both) {
    ASSERT_EQ(hand.positions_m.size(), hand.mesh->vertex_count());
    float farthest_m = 0;  // of a joint from the skin
    for (const auto& joint : hand.joints_m) {
      float nearest_m = 1;
      for (const auto& at : hand.positions_m)
        nearest_m = std::min(nearest_m, glm::distance(at, joint));
      farthest_m = std::max(farthest_m, nearest_m);
    }
    EXPECT_LT(farthest_m, 0.03f);
    EXPECT_NEAR(glm::length(hand.normals[100]), 1, 1e-3f);
  }
}

TEST_F(HandsTest, TheSurfaceOfAnImagesTimeStaysBesideTheOneOfTheLight) {
  tracked.follow(hands, 2);
  hands.needs_surface(true);
  const auto seen = hands.seen_at(ns(1.9));
  const glm::vec3 before = seen[0].positions_m[7];
  const auto shown = hands.at(ns(2));
  EXPECT_EQ(seen[0].positions_m[7], before);
  EXPECT_NE(shown[0].positions_m[7], before);
}

TEST_F(HandsTest, GravityIsThatOfTheRig) {
  config::Rig rig;
  rig.content.gravity = {0, 0, 1};  // the camera looks down
  auto from_above = *Hands::load(rig, tracked.calibration());
  EXPECT_LT(from_above.at(ns(1))[0].gravity.y, -0.9f) << "the back is up";
}

}  // namespace
}  // namespace handcast::content
