// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/orientation_bias.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "renderer/predict/projected_pose.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"

/// @file
/// Hands at rest in many views, 0.6 m from the camera, as a tracker reports them and as they are.

namespace handcast::renderer {
namespace {

constexpr int kViews = 40;
constexpr std::int64_t kBetween_ns = 100'000'000;

struct SeenHand {
  msg::HandPose reported;
  msg::HandLandmarks seen;
};

msg::HandPose posed(const glm::mat4& camera_from_wrist) {
  msg::HandPose pose;
  const auto rest = rest_frames(HandShape::mean());
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const glm::mat4 frame = camera_from_wrist * rest[j];
    pose.joints[j].position_m = {frame[3].x, frame[3].y, frame[3].z};
  }
  return pose;
}

class OrientationBiasTest : public testing::Test {
 protected:
  const calib::Calibration calibration_;
  std::mt19937 random_{7};
  std::int64_t time_ns_ = 10'000'000'000;

  double normal(double deviation) { return std::normal_distribution<>(0, deviation)(random_); }

  /// A hand tilted by up to `tilt_rad`; the tracker turns it by `wrong_rad` about the camera's
  /// axes.
  SeenHand view(double tilt_rad, glm::vec3 wrong_rad, double noise_px = 0) {
    const glm::mat4 back_to_camera(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
    const glm::mat4 tilt =
        glm::rotate(glm::rotate(glm::mat4(1), float(normal(tilt_rad)), {1, 0, 0}),
                    float(normal(tilt_rad)), {0, 1, 0});
    const glm::mat4 there = glm::translate(glm::mat4(1), {0, 0.05f, 0.6f});
    const float angle = glm::length(wrong_rad);
    const glm::mat4 wrong =
        angle > 0 ? glm::rotate(glm::mat4(1), angle, wrong_rad / angle) : glm::mat4(1);
    SeenHand both{posed(there * wrong * tilt * back_to_camera), {}};
    const auto truth =
        project_landmarks(calibration_, posed(there * tilt * back_to_camera)).value();
    for (std::size_t i = 0; i < truth.size(); ++i)
      both.seen.points[i] = {float(truth[i].x + normal(noise_px)),
                             float(truth[i].y + normal(noise_px)), 1, 0};
    return both;
  }

  OrientationBias learned(double tilt_rad, glm::vec3 wrong_rad, double noise_px = 0) {
    OrientationBias turn(calibration_);
    for (int i = 0; i < kViews; ++i, time_ns_ += kBetween_ns) {
      const SeenHand both = view(tilt_rad, wrong_rad, noise_px);
      turn.learn(time_ns_, both.reported, both.seen);
    }
    return turn;
  }
};

TEST_F(OrientationBiasTest, LearnsATurnAndUndoesIt) {
  const glm::vec3 wrong(0.06f, -0.05f, 0);
  const OrientationBias turn = learned(0.3, wrong);
  EXPECT_NEAR(turn.angle_rad().x, -wrong.x, 0.012);
  EXPECT_NEAR(turn.angle_rad().y, -wrong.y, 0.012);
  const SeenHand both = view(0.3, wrong);
  const auto joints_px = project_landmarks(calibration_, turn.turned(both.reported)).value(),
             before_px = project_landmarks(calibration_, both.reported).value();
  const auto miss = [&](const LandmarkPoints& points, std::size_t i) {
    return glm::distance(points[i], {both.seen.points[i].x_px, both.seen.points[i].y_px});
  };
  double turned_px = 0, reported_px = 0;
  for (std::size_t i = 0; i < joints_px.size(); ++i) {
    turned_px += miss(joints_px, i);
    reported_px += miss(before_px, i);
  }
  EXPECT_LT(turned_px, 0.3 * reported_px);
}

TEST_F(OrientationBiasTest, LearnsItFromNoisyLandmarks) {
  const glm::vec3 wrong(0.06f, -0.05f, 0);
  const OrientationBias turn = learned(0.3, wrong, 3);
  EXPECT_NEAR(turn.angle_rad().x, -wrong.x, 0.02);
  EXPECT_NEAR(turn.angle_rad().y, -wrong.y, 0.02);
}

TEST_F(OrientationBiasTest, AShiftAScaleAndARollAreNoTurn) {
  OrientationBias turn(calibration_);
  for (int i = 0; i < kViews; ++i, time_ns_ += kBetween_ns) {
    SeenHand both = view(0.3, {0, 0, 0.05f});
    for (auto& point : both.seen.points) {
      point.x_px = 1.05f * point.x_px + 20;
      point.y_px = 1.05f * point.y_px - 30;
    }
    turn.learn(time_ns_, both.reported, both.seen);
  }
  EXPECT_LT(glm::length(turn.angle_rad()), 0.01);
}

TEST_F(OrientationBiasTest, ManyImagesOfOnePoseCountAsFew) {
  const glm::vec3 wrong(0.06f, 0, 0);
  OrientationBias many(calibration_), few(calibration_);
  const SeenHand both = view(0, wrong);
  for (int i = 0; i < 200; ++i) many.learn(time_ns_ + i * 1'000'000, both.reported, both.seen);
  few.learn(time_ns_, both.reported, both.seen);
  EXPECT_LT(std::abs(many.angle_rad().x), 2 * std::abs(few.angle_rad().x));
}

TEST_F(OrientationBiasTest, ALandmarkThatNoCameraSeesTeachesNothing) {
  const SeenHand both = view(0.3, {0.06f, 0, 0});
  const auto taught = [&](const auto& spoil) {
    OrientationBias turn(calibration_);
    auto seen = both.seen;
    spoil(seen.points[8]);
    turn.learn(time_ns_, both.reported, seen);
    return turn.angle_rad();
  };
  const auto without = taught([](msg::Landmark& point) { point.confidence = 0; });
  EXPECT_GT(glm::length(without), 0);
  for (const float x_px : {NAN, INFINITY, 1e6f})
    EXPECT_EQ(taught([x_px](msg::Landmark& point) { point.x_px = x_px; }), without) << x_px;
}

TEST_F(OrientationBiasTest, NeverTurnsFarAndIgnoresWhatIsNotSeen) {
  OrientationBias turn(calibration_);
  for (int i = 0; i < kViews; ++i, time_ns_ += kBetween_ns) {
    const SeenHand both = view(0.3, {0.9f, 0, 0});
    turn.learn(time_ns_, both.reported, both.seen);
  }
  EXPECT_LT(glm::length(turn.angle_rad()), 0.21);

  OrientationBias blind(calibration_);
  SeenHand both = view(0.3, {0.1f, 0, 0});
  for (auto& point : both.seen.points) point.confidence = 0;
  blind.learn(time_ns_, both.reported, both.seen);
  both.reported.joints[1].position_m[2] = -1;  // the wrist is behind the camera
  blind.learn(time_ns_ + kBetween_ns, both.reported, view(0.3, {0.1f, 0, 0}).seen);
  EXPECT_EQ(glm::length(blind.angle_rad()), 0);
}

}  // namespace
}  // namespace handcast::renderer
