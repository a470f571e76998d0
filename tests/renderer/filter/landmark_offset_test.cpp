// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_offset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <random>

#include "renderer/predict/projected_pose.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"

/// @file
/// Hands at rest in many views, 0.6 m from the camera, whose detector sees some joints elsewhere
/// than the tracker.

namespace handcast::renderer {
namespace {

constexpr int kViews = 100;
constexpr std::int64_t kBetween_ns = 100'000'000;
constexpr int kIndexKnuckle = 5;

msg::HandPose posed(const glm::mat4& camera_from_wrist) {
  msg::HandPose pose;
  const auto rest = rest_frames(HandShape::mean());
  for (std::size_t j = 0; j < rest.size(); ++j) {
    const glm::mat4 frame = camera_from_wrist * rest[j];
    const glm::quat turn = glm::quat_cast(glm::mat3(frame));
    pose.joints[j].position_m = {frame[3].x, frame[3].y, frame[3].z};
    pose.joints[j].orientation_xyzw = {turn.x, turn.y, turn.z, turn.w};
  }
  return pose;
}

class LandmarkOffsetTest : public testing::Test {
 protected:
  const calib::Calibration calibration_;
  LandmarkOffset offset_{calibration_};
  std::mt19937 random_{7};
  std::int64_t time_ns_ = 10'000'000'000;

  double normal(double deviation) { return std::normal_distribution<>(0, deviation)(random_); }

  msg::HandPose any_view() {
    const glm::mat4 back_to_camera(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
    const glm::mat4 tilt =
        glm::rotate(glm::rotate(glm::rotate(glm::mat4(1), float(normal(0.5)), {1, 0, 0}),
                                float(normal(0.5)), {0, 1, 0}),
                    float(normal(1)), {0, 0, 1});
    return posed(glm::translate(glm::mat4(1), {0, 0.05f, 0.6f}) * tilt * back_to_camera);
  }

  /// The landmarks of `pose`, with that of the index finger's knuckle displaced in its own frame.
  msg::HandLandmarks seen(const msg::HandPose& pose, glm::vec3 knuckle_m, double noise_px = 0) {
    msg::HandPose displaced = pose;
    auto& joint = displaced.joints[static_cast<std::size_t>(msg::kJointOfLandmark[kIndexKnuckle])];
    const auto& [x, y, z, w] = joint.orientation_xyzw;
    const glm::vec3 by = glm::quat(w, x, y, z) * knuckle_m;
    for (int axis = 0; axis < 3; ++axis)
      joint.position_m[static_cast<std::size_t>(axis)] += by[axis];
    const auto points = project_landmarks(calibration_, displaced).value();
    msg::HandLandmarks result;
    for (std::size_t i = 0; i < points.size(); ++i)
      result.points[i] = {float(points[i].x + normal(noise_px)),
                          float(points[i].y + normal(noise_px)), 1, 0};
    return result;
  }

  /// The distance in px of the landmark of the index finger's knuckle from its joint.
  double distance_px(const msg::HandPose& pose, const msg::HandLandmarks& seen) const {
    const auto joint = project_landmarks(calibration_, pose).value()[kIndexKnuckle];
    const auto& point = seen.points[kIndexKnuckle];
    return std::hypot(point.x_px - joint.x, point.y_px - joint.y);
  }
};

TEST_F(LandmarkOffsetTest, AJointSeenElsewhereOnTheHandIsLearnedInTheFrameOfItsBone) {
  const glm::vec3 elsewhere_m(0.004f, 0, -0.006f);
  for (int i = 0; i < kViews; ++i) {
    const auto pose = any_view();
    offset_.learn(time_ns_ += kBetween_ns, pose, seen(pose, elsewhere_m, 1));
  }
  EXPECT_LT(glm::length(offset_.displacement_m(kIndexKnuckle) - glm::dvec3(elsewhere_m)), 0.0015);
  const auto pose = any_view();
  const auto landmarks = seen(pose, elsewhere_m);
  offset_.learn(time_ns_ += kBetween_ns, pose, landmarks);
  EXPECT_LT(distance_px(pose, offset_.as_tracked(landmarks)), 0.5 * distance_px(pose, landmarks));
}

TEST_F(LandmarkOffsetTest, AHandThatIsElsewhereIsNotAnOffset) {
  for (int i = 0; i < kViews; ++i) {
    const auto pose = any_view();
    auto landmarks = seen(pose, {});
    for (auto& point : landmarks.points) point.x_px += 20;
    offset_.learn(time_ns_ += kBetween_ns, pose, landmarks);
  }
  for (int i = 0; i < msg::kLandmarks; ++i)
    EXPECT_LT(glm::length(offset_.displacement_m(i)), 0.0003) << "landmark " << i;
}

TEST_F(LandmarkOffsetTest, AFoldedFingerThatTheTrackerGuessesIsNotAnOffset) {
  constexpr int kIndexTip = 8;
  const auto learned_m = [&](float bend_rad) {
    offset_ = LandmarkOffset(calibration_);
    for (int i = 0; i < kViews; ++i) {
      auto pose = any_view();
      auto landmarks = seen(pose, {});
      landmarks.points[kIndexTip].x_px += 6;
      for (int k = 0; k < 3; ++k) {
        auto& [x, y, z, w] =
            pose.joints[static_cast<std::size_t>(msg::kJointOfLandmark[kIndexKnuckle + k])]
                .orientation_xyzw;
        const glm::quat bent =
            glm::quat(w, x, y, z) *
            glm::angleAxis(-bend_rad * static_cast<float>(k + 1), glm::vec3(1, 0, 0));
        x = bent.x, y = bent.y, z = bent.z, w = bent.w;
      }
      offset_.learn(time_ns_ += kBetween_ns, pose, landmarks);
    }
    return glm::length(offset_.displacement_m(kIndexTip));
  };
  EXPECT_GT(learned_m(0.1f), 0.0005);
  EXPECT_EQ(learned_m(1.2f), 0);
}

TEST_F(LandmarkOffsetTest, OneImageTeachesLittle) {
  const auto pose = any_view();
  for (int i = 0; i < 3; ++i)
    offset_.learn(time_ns_ += 1'000'000, pose, seen(pose, {0, 0, -0.01f}));
  EXPECT_LT(glm::length(offset_.displacement_m(kIndexKnuckle)), 0.005);
}

TEST_F(LandmarkOffsetTest, ALandmarkFarAwayDoesNotTeachMoreThanANearOne) {
  for (int i = 0; i < kViews; ++i) {
    const auto pose = any_view();
    auto landmarks = seen(pose, {});
    if (i % 4 == 0) landmarks.points[kIndexKnuckle].x_px += 200;
    offset_.learn(time_ns_ += kBetween_ns, pose, landmarks);
  }
  EXPECT_LT(glm::length(offset_.displacement_m(kIndexKnuckle)), 0.002);
}

TEST_F(LandmarkOffsetTest, LandmarksThatAreMissingOrNoNumbersAreIgnored) {
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  for (int i = 0; i < kViews; ++i) {
    const auto pose = any_view();
    auto landmarks = seen(pose, {0, 0, -0.006f});
    landmarks.points[8].x_px = not_a_number;
    landmarks.points[12].sigma_px = not_a_number;
    landmarks.points[16] = {5000, 5000, 0, 1};
    offset_.learn(time_ns_ += kBetween_ns, pose, landmarks);
  }
  EXPECT_GT(glm::length(offset_.displacement_m(kIndexKnuckle)), 0.003);
  for (const int missing : {8, 12, 16})
    EXPECT_EQ(offset_.displacement_m(missing), glm::dvec3(0)) << missing;
}

}  // namespace
}  // namespace handcast::renderer
