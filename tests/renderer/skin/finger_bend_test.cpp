// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/finger_bend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/base/joint_math.hpp"
#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/hand_pose.hpp"
#include "tests/renderer/poses.hpp"

/// @file
/// A hand 0.6 m from the camera, whose tracker has the fingers straighter than they are.

namespace handcast::renderer {
namespace {

constexpr samples::Pose kTrue{
    "true",
    {10, 10, 0, 25, 35},
    {{{0, 50, 50, 30}, {0, 55, 50, 30}, {0, 55, 55, 30}, {0, 50, 50, 30}}}};
constexpr samples::Pose kReported{
    "reported",
    {10, 10, 0, 15, 20},
    {{{0, 38, 40, 22}, {0, 43, 40, 22}, {0, 43, 45, 22}, {0, 38, 40, 22}}}};

class FingerBend : public ::testing::TestWithParam<Side> {
 protected:
  msg::HandPose pose(const samples::Pose& of) const {
    return pose_of(GetParam(), samples::posed(mesh_, of), {0, 0.05f, 0});
  }
  LandmarkPoints seen(const msg::HandPose& pose) const {
    return project_landmarks(calibration_, pose).value();
  }
  msg::HandPose bent(const msg::HandPose& pose, const LandmarkPoints& landmarks_px) const {
    return renderer::bent(pose, landmarks_px, calibration_);
  }

  const HandMesh mesh_ = *load_hand_or_default({}, GetParam());
  const calib::Calibration calibration_ = [] {
    calib::Calibration calibration;
    calibration.camera_from_tracker =
        glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.05, 0.6, 1});
    return calibration;
  }();
};
INSTANTIATE_TEST_SUITE_P(Sides, FingerBend, ::testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "left" : "right";
                         });

/// How far a joint of the pose is turned from the true one, rad.
float turned_rad(const msg::HandPose& pose, const msg::HandPose& truth, int landmark) {
  const auto joint = static_cast<std::size_t>(msg::kJointOfLandmark[landmark]);
  return angle_between(orientation(pose.joints[joint]), orientation(truth.joints[joint]));
}

/// The mean over all joints of the fingers, without the tips.
float turned_rad(const msg::HandPose& pose, const msg::HandPose& truth) {
  float sum = 0;
  for (int finger = 0; finger < kFingers; ++finger)
    for (int i = 0; i < kLandmarksOfFinger - 1; ++i)
      sum += turned_rad(pose, truth, first_landmark(finger) + i);
  return sum / (kFingers * (kLandmarksOfFinger - 1));
}

glm::vec3 at(const msg::HandPose& pose, int landmark) {
  return position(pose.joints[static_cast<std::size_t>(msg::kJointOfLandmark[landmark])]);
}

TEST_P(FingerBend, FingersAreBentAsTheLandmarksShow) {
  const auto truth = pose(kTrue), reported = pose(kReported);
  const auto result = bent(reported, seen(truth));
  EXPECT_LT(turned_rad(result, truth), 0.4f * turned_rad(reported, truth));
  for (const int tip : {4, 8, 12, 16, 20})
    EXPECT_LT(glm::distance(at(result, tip), at(truth, tip)),
              0.4f * glm::distance(at(reported, tip), at(truth, tip)))
        << tip;
}

TEST_P(FingerBend, BonesKeepTheirLengthsAndKnucklesTheirPlaces) {
  const auto reported = pose(kReported), result = bent(reported, seen(pose(kTrue)));
  for (int finger = 0; finger < kFingers; ++finger) {
    const int first = first_landmark(finger);
    EXPECT_EQ(at(result, first), at(reported, first));
    for (int i = first; i + 1 < first + kLandmarksOfFinger; ++i)
      EXPECT_NEAR(glm::distance(at(result, i), at(result, i + 1)),
                  glm::distance(at(reported, i), at(reported, i + 1)), 1e-6f);
  }
}

TEST_P(FingerBend, NoisyLandmarksBendLessThanTheyHelp) {
  const auto truth = pose(kTrue), reported = pose(kReported);
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, 4);
  float wrong = 0, right = 0;
  for (int i = 0; i < 20; ++i) {
    auto noisy = seen(truth), still = seen(reported);
    for (auto& point : noisy) point += glm::vec2(noise(random), noise(random));
    for (auto& point : still) point += glm::vec2(noise(random), noise(random));
    right += turned_rad(bent(reported, noisy), truth) / 20;
    wrong += turned_rad(bent(reported, still), reported) / 20;
  }
  EXPECT_LT(right, 0.7f * turned_rad(reported, truth));
  EXPECT_LT(wrong, 0.07f) << "a tracker that is right";
}

TEST_P(FingerBend, AShiftOfAFingerIsNoBend) {
  const auto reported = pose(kReported);
  auto landmarks_px = seen(reported);
  for (int i = 0; i < kLandmarks; ++i)
    landmarks_px[i] += glm::vec2(20, -15) * static_cast<float>(1 + finger_of_landmark(i));
  EXPECT_LT(turned_rad(bent(reported, landmarks_px), reported), 1e-4f);
}

TEST_P(FingerBend, WildLandmarksBendNoJointFar) {
  const auto reported = pose(kReported);
  LandmarkPoints wild_px{};
  for (int i = 0; i < kLandmarks; ++i)
    wild_px[i] = {(i % 2 ? 1e4f : -1e4f), (i % 3 ? -1e4f : 1e4f)};
  const auto result = bent(reported, wild_px);
  for (int i = 1; i < kLandmarks; ++i) {
    const auto place_in_finger = static_cast<float>((i - 1) % kLandmarksOfFinger);
    EXPECT_LT(turned_rad(result, reported, i), 0.61f * (1 + place_in_finger)) << i;
  }
}

TEST_P(FingerBend, ALandmarkThatIsNotFiniteOrAJointBehindTheCameraLeavesItsFingerAlone) {
  auto reported = pose(kReported);
  auto landmarks_px = seen(pose(kTrue));
  landmarks_px[3].y = INFINITY;
  landmarks_px[7].x = NAN;
  reported.joints[static_cast<std::size_t>(msg::kJointOfLandmark[12])].position_m = {0, 2, 0};
  const auto result = bent(reported, landmarks_px);
  for (const int alone : {2, 3, 5, 6, 7, 9, 10, 11})
    EXPECT_EQ(turned_rad(result, reported, alone), 0) << alone;
  EXPECT_GT(turned_rad(result, reported, 14), 0.05f) << "the ring finger";
}

}  // namespace
}  // namespace handcast::renderer
