// SPDX-License-Identifier: Apache-2.0
#include "services/pose/openxr/sampler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace handcast::pose::openxr {
namespace {

Answer hand_at(float x_m, int tracked = msg::kJoints) {
  Answer answer{.is_active = true, .is_whole = true, .tracked = tracked};
  for (auto& joint : answer.joints) joint = {.position_m = {x_m, 0.1f, -0.2f}, .radius_m = 0.01f};
  return answer;
}

class OneSampler : public testing::Test {
 protected:
  OneSampler() { sampler_.take({hand_at(0), hand_at(1)}, poses_).value(); }
  Sampler sampler_;
  msg::HandPoses poses_;
};

TEST(Sampler, TheFirstAnswersAreNoSample) {
  Sampler sampler;
  msg::HandPoses poses;
  EXPECT_FALSE(sampler.take({hand_at(0), {}}, poses).value());
}

TEST_F(OneSampler, AnswersThatAreEqualBitByBitAreNoSample) {
  EXPECT_FALSE(sampler_.take({hand_at(0), hand_at(1)}, poses_).value());
  EXPECT_TRUE(sampler_.take({hand_at(0), hand_at(1 + 1e-6f)}, poses_).value());
  EXPECT_EQ(poses_.count, 2u);
  EXPECT_FALSE(sampler_.take({hand_at(0), hand_at(1 + 1e-6f)}, poses_).value());
}

TEST_F(OneSampler, JointsKeepTheirOrderAxesAndSide) {
  ASSERT_TRUE(sampler_.take({Answer{}, hand_at(2)}, poses_).value());
  ASSERT_EQ(poses_.count, 1u);
  EXPECT_EQ(poses_.hands[0].side, msg::Side::right);
  EXPECT_EQ(poses_.hands[0].joints[25].position_m, (std::array{2.f, 0.1f, -0.2f}));
  EXPECT_EQ(poses_.hands[0].joints[25].radius_m, 0.01f);
}

TEST_F(OneSampler, AnswersWithoutAHandAreSamplesToo) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(sampler_.take({}, poses_).value()) << "the tracker works";
    EXPECT_EQ(poses_.count, 0u);
  }
}

TEST_F(OneSampler, AHandWithAJointThatIsNotKnownIsLeftOut) {
  auto partial = hand_at(3);
  partial.is_whole = false;
  ASSERT_TRUE(sampler_.take({partial, hand_at(4)}, poses_).value());
  ASSERT_EQ(poses_.count, 1u);
  EXPECT_EQ(poses_.hands[0].side, msg::Side::right);
}

TEST_F(OneSampler, JointsThatNoHandHasDoNotReachARing) {
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  const auto spoilt = [](float x_m, float turn, float radius_m) {
    auto answer = hand_at(5);
    answer.joints[12].position_m[0] = x_m;
    answer.joints[12].orientation_xyzw[3] = turn;
    answer.joints[12].radius_m = radius_m;
    return answer;
  };
  for (const auto& bad : {spoilt(nan, 1, 0), spoilt(1e9f, 1, 0), spoilt(0, 0, 0), spoilt(0, nan, 0),
                          spoilt(0, 1, nan), spoilt(0, 1, -1)}) {
    const auto alone = sampler_.take({bad, {}}, poses_);
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error().code, Errc::bad_data);
    ASSERT_TRUE(sampler_.take({bad, hand_at(6)}, poses_).value()) << "the other hand goes on";
    EXPECT_EQ(poses_.count, 1u);
  }
}

TEST_F(OneSampler, InferredJointsCountHalf) {
  ASSERT_TRUE(sampler_.take({hand_at(7, 26), hand_at(7, 0)}, poses_).value());
  EXPECT_EQ(poses_.hands[0].confidence, 1);
  EXPECT_EQ(poses_.hands[1].confidence, 0.5f);
}

TEST(Sampler, NoHandDoesNotShowWhetherARuntimeRegardsTheTime) {
  EXPECT_FALSE(Sampler::are_equal({}, {}));
  EXPECT_TRUE(Sampler::are_equal({hand_at(1), {}}, {hand_at(1), {}}));
  EXPECT_FALSE(Sampler::are_equal({hand_at(1), {}}, {hand_at(2), {}}));
  EXPECT_FALSE(Sampler::are_equal({hand_at(1), {}}, {Answer{}, hand_at(1)}));
}

}  // namespace
}  // namespace handcast::pose::openxr
