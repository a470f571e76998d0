// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/pose_history.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "tests/milliseconds.hpp"

namespace handcast::renderer {
namespace {

/// All joints at `at`, rotated by `angle` about z.
msg::HandPose pose_at(glm::vec3 at, float angle = 0) {
  msg::HandPose pose;
  pose.side = Side::right;
  for (auto& joint : pose.joints) {
    joint.position_m = {at.x, at.y, at.z};
    joint.orientation_xyzw = {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
  }
  return pose;
}

float x_of(const std::optional<msg::HandPose>& pose) { return pose->joints[10].position_m[0]; }

float angle_of(const std::optional<msg::HandPose>& pose) {
  const auto& q = pose->joints[10].orientation_xyzw;
  return 2 * std::atan2(q[2], q[3]);
}

config::Predict by_velocity() {
  config::Predict settings;
  settings.method = config::PredictMethod::velocity;
  return settings;
}

/// Samples every 9 ms of a hand that moves at `m_s` along x and rotates at `rad_s`.
PoseHistory moving(float m_s, float rad_s = 0, const config::Predict& settings = by_velocity()) {
  PoseHistory history(settings);
  for (int i = 0; i <= 10; ++i) {
    const float t = static_cast<float>(i) * 9e-3f;
    history.push(i * 9 * kMs, pose_at({m_s * t, 0, 0}, rad_s * t));
  }
  return history;
}

TEST(PoseHistory, AnEmptyHistoryKnowsNothing) {
  const PoseHistory history(by_velocity());
  EXPECT_TRUE(history.empty());
  EXPECT_EQ(history.newest_ns(), 0);
  EXPECT_FALSE(history.at(5 * kMs));
}

TEST(PoseHistory, InsideTheHistoryPosesAreInterpolated) {
  const PoseHistory history = moving(1.0f, 2.0f);
  EXPECT_NEAR(x_of(history.at(40 * kMs)), 0.040f, 1e-6f);
  EXPECT_NEAR(angle_of(history.at(40 * kMs)), 0.080f, 1e-5f);
  EXPECT_EQ(history.at(40 * kMs)->side, Side::right);
}

TEST(PoseHistory, BeforeTheOldestSampleTheOldestIsGiven) {
  EXPECT_FLOAT_EQ(x_of(moving(1.0f).at(-100 * kMs)), 0);
}

TEST(PoseHistory, BeyondTheNewestSampleTheMotionGoesOn) {
  const PoseHistory history = moving(1.0f, 2.0f);
  EXPECT_NEAR(x_of(history.at(105 * kMs)), 0.105f, 1e-5f);
  EXPECT_NEAR(angle_of(history.at(105 * kMs)), 0.210f, 1e-4f);
}

TEST(PoseHistory, HoldKeepsTheNewestPose) {
  config::Predict hold;
  hold.method = config::PredictMethod::hold;
  EXPECT_NEAR(x_of(moving(1.0f, 0, hold).at(105 * kMs)), 0.090f, 1e-6f);
}

TEST(PoseHistory, ExtrapolationStopsAtItsLimit) {
  config::Predict settings = by_velocity();
  settings.limit_ms = 20;
  EXPECT_NEAR(x_of(moving(1.0f, 0, settings).at(160 * kMs)), 0.110f, 1e-5f);
}

TEST(PoseHistory, AnAcceleratingHandIsFollowedBetterWithItsAcceleration) {
  config::Predict settings = by_velocity();
  std::array<float, 2> error_m{};
  for (const int which : {0, 1}) {
    if (which) settings.method = config::PredictMethod::acceleration;
    PoseHistory history(settings);
    const auto place = [](float t) { return 0.5f * 25 * t * t; };  // 25 m/s^2: a hand shaken hard
    for (int i = 0; i <= 10; ++i)
      history.push(i * 9 * kMs, pose_at({place(static_cast<float>(i) * 9e-3f), 0, 0}));
    error_m[which] = std::abs(x_of(history.at(104 * kMs)) - place(0.104f));
  }
  EXPECT_LT(error_m[1], 0.3f * error_m[0]);
}

TEST(PoseHistory, AFingerThatSnapsDoesNotAccelerateTheHand) {
  PoseHistory history = moving(0.5f, 0, {});
  auto snapped = pose_at({0.0495f, 0, 0});
  for (int j = 8; j <= 10; ++j) snapped.joints[j].position_m[1] = 0.02f;
  history.push(99 * kMs, snapped);
  for (const int j : {0, 15})
    EXPECT_NEAR(history.at(117 * kMs)->joints[j].position_m[1], 0, 1e-5f) << j;
}

TEST(PoseHistory, AFastTurnIsNotExtrapolatedRoundAndRound) {
  const PoseHistory history = moving(0, 100.0f);
  EXPECT_LT(std::abs(std::remainder(angle_of(history.at(130 * kMs)) - 9.0f, 6.2831853f)), 1.01f);
}

TEST(PoseHistory, AHandThatIsLostIsNotInvented) {
  const PoseHistory history = moving(1.0f);
  EXPECT_TRUE(history.at(289 * kMs));
  EXPECT_FALSE(history.at(291 * kMs));
  EXPECT_FALSE(history.at(131 * kMs, 40 * kMs));
}

TEST(PoseHistory, AStillHandIsHeldThoughItsSamplesAreNoisy) {
  PoseHistory history(by_velocity());
  const float noise_m[] = {1e-4f, -1e-4f, 0.5e-4f, -1e-4f, 1e-4f, -0.7e-4f, 1e-4f};
  for (int i = 0; i < 7; ++i) history.push(i * 9 * kMs, pose_at({noise_m[i], 0, 0}));
  // Two-point velocity would be 19 mm/s here and put the joint 0.5 mm off.
  EXPECT_NEAR(x_of(history.at(75 * kMs)), 0, 0.05e-3f);
}

TEST(PoseHistory, AHandThatStartsToMoveIsFollowedAtOnce) {
  PoseHistory history(by_velocity());
  for (int i = 0; i < 8; ++i) history.push(i * 9 * kMs, pose_at({0, 0, 0}));
  history.push(72 * kMs, pose_at({2e-3f, 0, 0}));
  EXPECT_NEAR(x_of(history.at(81 * kMs)), 4e-3f, 1e-5f);
}

TEST(PoseHistory, TheGateOfStillnessOpensWithoutASwitch) {
  float before_m = 0;
  for (float mm_s = 1; mm_s < 30; mm_s += 0.25f) {
    const float ahead_m = x_of(moving(mm_s * 1e-3f).at(102 * kMs)) - 90e-6f * mm_s;
    if (mm_s > 1) {
      EXPECT_LT(std::abs(ahead_m - before_m), 0.04e-3f) << mm_s;
    }
    before_m = ahead_m;
  }
}

TEST(PoseHistory, OrderOfArrivalDoesNotMatter) {
  PoseHistory shuffled(by_velocity());
  for (const int i : {3, 0, 5, 1, 2, 10, 7, 4, 9, 8, 6})
    shuffled.push(i * 9 * kMs, pose_at({static_cast<float>(i) * 9e-3f, 0, 0}));
  const PoseHistory straight = moving(1.0f);
  EXPECT_EQ(shuffled.newest_ns(), straight.newest_ns());
  for (const std::int64_t time_ms : {0, 13, 40, 90, 99, 140}) {
    EXPECT_EQ(x_of(shuffled.at(time_ms * kMs)), x_of(straight.at(time_ms * kMs))) << time_ms;
  }
}

TEST(PoseHistory, ASampleSentAgainReplacesTheFirst) {
  PoseHistory history = moving(1.0f);
  history.push(90 * kMs, pose_at({0.5f, 0, 0}));
  EXPECT_FLOAT_EQ(x_of(history.at(90 * kMs)), 0.5f);
}

TEST(PoseHistory, TwoSamplesAtNearlyTheSameTimeDoNotMakeAHugeVelocity) {
  PoseHistory history = moving(1.0f);
  history.push(90 * kMs + 1000, pose_at({0.0901f, 0, 0}));  // 0.1 mm in 1 us
  EXPECT_NEAR(x_of(history.at(100 * kMs)), 0.100f, 0.5e-3f);
}

TEST(PoseHistory, BrokenSamplesAreLeftOut) {
  PoseHistory history = moving(1.0f);
  history.push(95 * kMs, pose_at({std::numeric_limits<float>::quiet_NaN(), 0, 0}));
  EXPECT_EQ(history.newest_ns(), 90 * kMs);
}

TEST(PoseHistory, QuaternionsOfEitherSignAreTheSameTurn) {
  PoseHistory history(by_velocity());
  msg::HandPose turned = pose_at({0, 0, 0}, 0.2f);
  for (auto& joint : turned.joints)
    for (float& x : joint.orientation_xyzw) x = -x;
  history.push(0, pose_at({0, 0, 0}, 0.1f));
  history.push(10 * kMs, turned);
  EXPECT_NEAR(std::remainder(angle_of(history.at(5 * kMs)), 6.2831853f), 0.15f, 1e-4f);
  EXPECT_NEAR(std::remainder(angle_of(history.at(15 * kMs)), 6.2831853f), 0.25f, 1e-3f);
}

TEST(PoseHistory, OldSamplesAreForgotten) {
  PoseHistory history({}, 50 * kMs);
  for (int i = 0; i <= 10; ++i)
    history.push(i * 9 * kMs, pose_at({static_cast<float>(i) * 9e-3f, 0, 0}));
  EXPECT_NEAR(x_of(history.at(0)), 0.045f, 1e-6f);
}

TEST(PoseHistory, ATrackerThatJumpsIsNotTakenForAFastHand) {
  PoseHistory history = moving(0.5f);
  EXPECT_EQ(history.push(99 * kMs, pose_at({0.0495f + 0.1f, 0, 0})),
            PoseHistory::Pushed::begins_anew);
  EXPECT_EQ(history.begins_ns(), 99 * kMs);
  EXPECT_FALSE(history.settled());
  EXPECT_NEAR(x_of(history.at(110 * kMs)), 0.1495f, 1e-5f);  // no velocity across the jump
  EXPECT_NEAR(x_of(history.at(95 * kMs)), 0.1495f, 1e-5f);   // no interpolation across it
  EXPECT_EQ(history.push(108 * kMs, pose_at({0.154f, 0, 0})), PoseHistory::Pushed::goes_on);
  EXPECT_EQ(history.push(117 * kMs, pose_at({0.1585f, 0, 0})), PoseHistory::Pushed::goes_on);
  EXPECT_TRUE(history.settled());
  EXPECT_NEAR(x_of(history.at(126 * kMs)), 0.163f, 1e-4f);
}

TEST(PoseHistory, AFingerThatJumpsIsAJumpAndAJointIsNot) {
  for (const int joints : {1, 5}) {
    PoseHistory history = moving(0.5f);
    auto pose = pose_at({0.0495f, 0, 0});
    for (int j = 6; j < 6 + joints; ++j) pose.joints[j].position_m[1] += 0.03f;
    EXPECT_EQ(history.push(99 * kMs, pose) == PoseHistory::Pushed::begins_anew, joints == 5);
  }
}

TEST(PoseHistory, NothingOlderThanAJumpComesIn) {
  PoseHistory history = moving(0.5f);
  history.push(99 * kMs, pose_at({0.2f, 0, 0}));
  EXPECT_EQ(history.push(95 * kMs, pose_at({0.0475f, 0, 0})), PoseHistory::Pushed::not_measured);
  EXPECT_NEAR(x_of(history.at(100 * kMs)), 0.2f, 1e-6f);
}

TEST(PoseHistory, AHandThatComesBackBeginsAnew) {
  PoseHistory history = moving(0.5f);
  EXPECT_EQ(history.push(190 * kMs, pose_at({0.1f, 0, 0})), PoseHistory::Pushed::begins_anew);
}

TEST(PoseHistory, AMovingHandThatIsSuddenlyTheSameToTheLastBitIsNotMeasured) {
  PoseHistory history = moving(0.5f);
  EXPECT_EQ(history.push(99 * kMs, *history.at(90 * kMs)), PoseHistory::Pushed::not_measured);
  EXPECT_EQ(history.newest_ns(), 90 * kMs);
  PoseHistory still = moving(0);
  EXPECT_EQ(still.push(99 * kMs, *still.at(90 * kMs)), PoseHistory::Pushed::goes_on);
}

TEST(PoseHistory, AHandThatWasShakenHardMayBeShakenOn) {
  // 3.4 m/s, 190 m/s^2
  const auto shaken = [](double s) {
    return static_cast<float>(0.06 * std::sin(2 * 3.14159265 * 9 * s));
  };
  PoseHistory history(by_velocity());
  for (int i = 0; i < 400; ++i) {
    const double s = i * 9e-3, swell = std::min(1.0, s / 0.5);
    ASSERT_EQ(history.push(i * 9 * kMs, pose_at({static_cast<float>(swell) * shaken(s), 0, 0})),
              PoseHistory::Pushed::goes_on)
        << i;
  }
}

}  // namespace
}  // namespace handcast::renderer
