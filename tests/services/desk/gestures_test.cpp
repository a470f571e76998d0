// SPDX-License-Identifier: Apache-2.0
#include "services/desk/gestures.hpp"

#include <gmock/gmock.h>

#include <random>

#include "tests/renderer/poses.hpp"

namespace handcast::desk {
namespace {

using renderer::samples::Pose;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
namespace samples = renderer::samples;

constexpr std::int64_t kMs = 1'000'000;

/// Hands in front of a rig, sampled 100 times a second. The space of the tracker is the camera's.
class GesturesTest : public testing::Test {
 protected:
  static const renderer::HandMesh& mesh(msg::Side side) {
    static const std::array kMeshes{*renderer::load_hand_or_default({}, msg::Side::left),
                                    *renderer::load_hand_or_default({}, msg::Side::right)};
    return kMeshes[static_cast<std::size_t>(side)];
  }
  /// A hand in a pose, turned about its own axes and moved.
  msg::HandPose held(msg::Side side, const Pose& pose, const glm::mat4& moved = glm::mat4(1)) {
    msg::HandPose hand;
    hand.side = side;
    hand.confidence = 1;
    const auto frames = samples::posed(mesh(side), pose);
    std::normal_distribution<float> noise(0, noise_m_);
    for (std::size_t j = 0; j < msg::kJoints; ++j) {
      const glm::vec3 at(moved * frames[j][3]);
      for (int axis = 0; axis < 3; ++axis)
        hand.joints[j].position_m[axis] = at[axis] + noise(random_);
    }
    return hand;
  }
  /// Shows hands for some time. Returns all events.
  std::vector<std::string> show(const std::vector<msg::HandPose>& hands, int ms) {
    std::vector<std::string> events;
    for (const auto until_ns = now_ns_ + ms * kMs; now_ns_ < until_ns; now_ns_ += 10 * kMs) {
      msg::HandPoses poses;
      poses.header.origin_ns = now_ns_;
      poses.count = static_cast<std::uint32_t>(hands.size());
      std::ranges::copy(hands, poses.hands.begin());
      if (!hands.empty()) gestures_.push(poses);
      const auto& scene = gestures_.at(now_ns_);
      events.insert(events.end(), scene.events.begin(), scene.events.end());
    }
    return events;
  }
  const Gesture& left() { return gestures_.at(now_ns_).gestures[0]; }

  std::int64_t now_ns_ = 1'000 * kMs;
  float noise_m_ = 0;
  std::mt19937 random_{7};
  Gestures gestures_{glm::mat4(1), {0, 1, 0}, {mesh(msg::Side::left), mesh(msg::Side::right)}};
};

TEST_F(GesturesTest, AHandAppearsOnceAndLeavesOnce) {
  EXPECT_THAT(show({held(msg::Side::left, samples::kPinch)}, 500), ElementsAre("left.appears"));
  EXPECT_TRUE(left().is_there);
  EXPECT_THAT(show({}, 250), IsEmpty()) << "a gap";
  EXPECT_THAT(show({held(msg::Side::left, samples::kPinch)}, 200), IsEmpty());
  EXPECT_THAT(show({}, 2000), ElementsAre("left.leaves"));
  EXPECT_NEAR(left().absent_s, 1.7, 0.05);
}

TEST_F(GesturesTest, AHandThatIsReportedForAMomentIsNone) {
  EXPECT_THAT(show({held(msg::Side::right, samples::kFist)}, 50), IsEmpty());
  EXPECT_THAT(show({}, 1000), IsEmpty());
}

TEST_F(GesturesTest, PosesAreToldApart) {
  show({held(msg::Side::left, samples::kOpen)}, 500);
  EXPECT_LT(left().fist, 0.1f);
  EXPECT_THAT(show({held(msg::Side::left, samples::kFist)}, 200), Contains("left.fist"));
  EXPECT_GT(left().fist, 0.9f);
  EXPECT_THAT(show({held(msg::Side::left, samples::kPoint)}, 200), Contains("left.point"));
  EXPECT_TRUE(left().is_pointing);
  EXPECT_THAT(show({held(msg::Side::left, samples::kOpen)}, 200), Contains("left.open"));
  EXPECT_FALSE(left().is_pointing);
  EXPECT_THAT(show({held(msg::Side::left, samples::kOk)}, 200), Contains("left.pinch"));
  EXPECT_GT(left().pinch, 0.85f);
}

TEST_F(GesturesTest, NoiseMakesNoEvents) {
  noise_m_ = 0.002f;
  std::vector<std::string> events;
  for (int sample = 0; sample < 500; ++sample) {
    const auto some = show({held(msg::Side::left, samples::kOk)}, 10);
    events.insert(events.end(), some.begin(), some.end());
  }
  EXPECT_LE(std::ranges::count(events, "left.pinch"), 1);
  EXPECT_THAT(events, Not(Contains("left.fist")));
}

TEST_F(GesturesTest, HandsTouchOnce) {
  const auto apart = glm::translate(glm::mat4(1), {0.5f, 0, 0});
  const auto open = held(msg::Side::left, samples::kOpen);
  EXPECT_THAT(show({open, held(msg::Side::right, samples::kOpen, apart)}, 500),
              Not(Contains("touch")));
  const auto events = show({open, held(msg::Side::right, samples::kOpen)}, 300);
  EXPECT_EQ(std::ranges::count(events, "touch"), 1);
  EXPECT_TRUE(left().touches_other);
}

TEST_F(GesturesTest, ThePalmLooksUpOrDown) {
  show({held(msg::Side::left, samples::kOpen)}, 500);
  const float up = left().palm_up;
  const auto over = glm::rotate(glm::mat4(1), glm::pi<float>(), {0, 0, 1});
  show({held(msg::Side::left, samples::kOpen, over)}, 500);
  EXPECT_GT(std::abs(up), 0.9f);
  EXPECT_NEAR(left().palm_up, -up, 0.01f);
}

TEST_F(GesturesTest, SpeedIsThatOfThePalm) {
  for (int i = 0; i < 60; ++i)
    show({held(msg::Side::left, samples::kOpen,
               glm::translate(glm::mat4(1), {0.005f * static_cast<float>(i), 0, 0}))},
         10);
  EXPECT_NEAR(left().speed_m_s, 0.5f, 0.02f);
}

}  // namespace
}  // namespace handcast::desk
