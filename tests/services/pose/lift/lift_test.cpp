// SPDX-License-Identifier: Apache-2.0
// The lift on the true landmarks of the twin's hands, whose bones are up to 4 % longer or shorter
// than the model's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/pose/lift/lifter.hpp"

namespace handcast::pose {
namespace {

constexpr std::int64_t kStep_ns = 3'200'000;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// How far the lifted poses of a run are from the truth.
struct Errors {
  std::vector<double> image_px;  ///< per landmark
  std::vector<double> depth_m;   ///< per landmark, relative to the palm
  std::vector<double> palm_rad;  ///< between the palms' normals
  std::vector<double> tips_rad;  ///< between the directions of the finger tips
};

class LiftTest : public testing::Test {
 protected:
  LiftTest() { rig_.twin.detector.noise_px = 0; }

  void open(const std::string& motion) {
    rig_.twin.motion = "builtin:" + motion;
    twin_ = std::move(twin::Twin::create(rig_, calibration_).value());
    lifter_.emplace(Lifter::open(rig_, calibration_).value());
  }
  msg::Landmarks seen(std::int64_t time_ns) {
    const auto run = run_++;
    auto landmarks = twin_->detect(run, run, time_ns).landmarks;
    landmarks.header.origin_ns = time_ns;
    return landmarks;
  }
  glm::dvec3 in_camera(const msg::HandPose& pose, int joint) const {
    const auto& [x, y, z] = pose.joints[joint].position_m;
    return glm::dvec3(calibration_.camera_from_tracker * glm::dvec4(x, y, z, 1));
  }
  void compare(std::int64_t time_ns, const msg::HandPose& pose, Errors& errors) const {
    const auto truth = twin_->joints(pose.side, time_ns).value();
    const auto true_m = [&](int joint) {
      return glm::dvec3(calibration_.camera_from_tracker *
                        glm::dvec4(glm::dvec3(truth[joint][3]), 1));
    };
    for (const int joint : msg::kJointOfLandmark) {
      const glm::dvec3 lifted = in_camera(pose, joint), right = true_m(joint);
      errors.image_px.push_back(
          glm::distance(calibration_.camera.project(lifted), calibration_.camera.project(right)));
      errors.depth_m.push_back(
          std::abs(lifted.z - in_camera(pose, kPalm).z - right.z + true_m(kPalm).z));
    }
    const auto angle = [&](int joint, int axis) {
      const auto& [x, y, z, w] = pose.joints[joint].orientation_xyzw;
      const glm::vec3 lifted = glm::mat3_cast(glm::quat(w, x, y, z))[axis];
      const glm::vec3 right(truth[joint][axis]);
      return std::acos(std::clamp(glm::dot(lifted, glm::normalize(right)), -1.0f, 1.0f));
    };
    errors.palm_rad.push_back(angle(kWrist, 1));
    for (const int first : kFirstJoint) errors.tips_rad.push_back(angle(first + 3, 2));
  }
  /// Lifts the left hand of a motion for `images` images.
  Errors follow(const std::string& motion, int images = 700) {
    open(motion);
    Errors errors;
    for (int i = 0; i < images; ++i) {
      const auto poses = lifter_->lift(seen(i * kStep_ns));
      const auto* pose = poses.find(msg::Side::left);
      EXPECT_TRUE(pose) << motion << ", image " << i;
      if (pose) compare(i * kStep_ns, *pose, errors);
    }
    return errors;
  }

  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::unique_ptr<twin::Twin> twin_;
  std::optional<Lifter> lifter_;
  std::uint64_t run_ = 0;
};

TEST_F(LiftTest, AHandIsLiftedOntoItsLandmarksWithTheDepthOfItsJoints) {
  for (const auto* motion : {"open_close", "rotate", "pinch", "shake"}) {
    const Errors errors = follow(motion);
    EXPECT_LT(mean_of(errors.image_px), 1.5) << motion;
    EXPECT_LT(mean_of(errors.depth_m), 8e-3) << motion;
    EXPECT_LT(mean_of(errors.palm_rad), 0.1) << motion;
    EXPECT_LT(mean_of(errors.tips_rad), 0.35) << motion;
  }
}

TEST_F(LiftTest, AFistAnEdgeOnHandAndOneThatPointsAtTheCameraAreLifted) {
  for (const auto* motion : {"fist", "flip", "point_at_camera"}) {
    const Errors errors = follow(motion);
    EXPECT_LT(mean_of(errors.image_px), 2) << motion;
    EXPECT_LT(mean_of(errors.depth_m), 10e-3) << motion;
    EXPECT_LT(*std::ranges::max_element(errors.palm_rad), 0.8) << motion << ": never turned over";
  }
}

TEST_F(LiftTest, NoiseOfFourPixelsDoesNotTurnAHandOver) {
  rig_.twin.detector.noise_px = 4;
  for (const auto* motion : {"wave", "point_at_camera"}) {
    const Errors errors = follow(motion);
    EXPECT_LT(mean_of(errors.image_px), 3) << "less than the noise, whose mean is 5 px";
    EXPECT_LT(mean_of(errors.depth_m), 15e-3);
    EXPECT_LT(*std::ranges::max_element(errors.palm_rad), 0.8);
  }
}

TEST_F(LiftTest, TwoHandsAreLiftedEachByItsOwnModel) {
  open("two_hands");
  Errors errors;
  for (int i = 0; i < 200; ++i) {
    const auto poses = lifter_->lift(seen(i * kStep_ns));
    ASSERT_EQ(poses.count, 2u);
    for (const auto& pose : poses.hands) compare(i * kStep_ns, pose, errors);
  }
  EXPECT_LT(mean_of(errors.image_px), 1.5);
  EXPECT_LT(mean_of(errors.depth_m), 8e-3);
}

TEST_F(LiftTest, AWrongDistanceMakesAnotherSizeNotAnotherPlace) {
  for (const double wrong_m : {-0.1, 0.1}) {
    rig_.pose.none.distance_m = 0.73 + wrong_m;
    const Errors errors = follow("open_close");
    EXPECT_LT(mean_of(errors.image_px), 1.5) << wrong_m;
    EXPECT_LT(mean_of(errors.depth_m), 10e-3) << wrong_m;
    const auto pose = lifter_->lift(seen(10'000'000'000)).hands[0];
    EXPECT_NEAR(in_camera(pose, kPalm).z, rig_.pose.none.distance_m, 0.05);
  }
}

TEST_F(LiftTest, AHandThatComesNearerKeepsItsSize) {
  open("still");
  const auto hand = seen(0);
  const auto nearer = [&](double factor) {
    auto landmarks = hand;
    for (auto& point : landmarks.hands[0].points) {
      point.x_px = static_cast<float>(359.5 + factor * (point.x_px - 359.5));
      point.y_px = static_cast<float>(269.5 + factor * (point.y_px - 269.5));
    }
    return landmarks;
  };
  std::optional<msg::HandPose> before, after;
  for (int i = 0; i < 1000; ++i) {
    auto landmarks = nearer(i < 600 ? 1 : std::min(1.15, 1 + 0.001 * (i - 600)));
    landmarks.header.origin_ns = i * kStep_ns;
    (i < 600 ? before : after) = lifter_->lift(landmarks).hands[0];
  }
  const auto palm_m = [&](const msg::HandPose& pose) {
    return glm::distance(in_camera(pose, 1), in_camera(pose, 12));
  };
  EXPECT_NEAR(palm_m(*after) / palm_m(*before), 1, 0.05);
  EXPECT_NEAR(in_camera(*after, kPalm).z / in_camera(*before, kPalm).z, 1 / 1.15, 0.05);
}

TEST_F(LiftTest, TheLengthOfThePersonsHandIsTheSizeToBeginWith) {
  rig_.pose.none.hand_length_mm = 150;
  open("still");
  const auto small = lifter_->lift(seen(0)).hands[0];
  rig_.pose.none.hand_length_mm = 220;
  open("still");
  const auto large = lifter_->lift(seen(0)).hands[0];
  EXPECT_LE(glm::distance(in_camera(small, 1), in_camera(small, 12)),
            glm::distance(in_camera(large, 1), in_camera(large, 12)));
}

TEST_F(LiftTest, LandmarksThatWereNotSeenPullAtNothing) {
  open("wave");
  Errors errors;
  for (int i = 0; i < 200; ++i) {
    auto landmarks = seen(i * kStep_ns);
    for (const int k : {6, 7, 8}) {
      landmarks.hands[0].points[k].x_px += 150;
      landmarks.hands[0].points[k].confidence = 0;
    }
    compare(i * kStep_ns, lifter_->lift(landmarks).hands[0], errors);
  }
  std::vector<double> of_others;
  for (std::size_t i = 0; i < errors.image_px.size(); ++i)
    if (const auto k = i % 21; k < 6 || k > 8) of_others.push_back(errors.image_px[i]);
  EXPECT_LT(mean_of(of_others), 1.5);
  EXPECT_LT(mean_of(errors.image_px), 8) << "the finger is where hands have it";
}

TEST_F(LiftTest, AnOutlierIsOverruled) {
  open("wave");
  Errors errors;
  for (int i = 0; i < 200; ++i) {
    auto landmarks = seen(i * kStep_ns);
    if (i % 7 == 0) landmarks.hands[0].points[static_cast<std::size_t>(i) % 21].y_px += 120;
    compare(i * kStep_ns, lifter_->lift(landmarks).hands[0], errors);
  }
  EXPECT_LT(mean_of(errors.image_px), 2.5);
}

TEST_F(LiftTest, AHandThatReturnsInAnotherPostureIsLiftedAtOnce) {
  open("open_close");
  for (int i = 0; i < 100; ++i) lifter_->lift(seen(i * kStep_ns));
  const std::int64_t later_ns = 2'000'000'000;
  auto elsewhere = seen(later_ns);
  for (auto& point : elsewhere.hands[0].points) point.x_px += 120;
  const auto pose = lifter_->lift(elsewhere).hands[0];
  double sum_px = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = elsewhere.hands[0].points[i];
    sum_px += glm::distance(calibration_.camera.project(in_camera(pose, msg::kJointOfLandmark[i])),
                            glm::dvec2(point.x_px, point.y_px));
  }
  EXPECT_LT(sum_px / msg::kLandmarks, 2.5);
}

TEST_F(LiftTest, TheOriginIsThatOfTheImage) {
  open("wave");
  auto landmarks = seen(77);
  landmarks.header.frame_id = 5;
  const auto poses = lifter_->lift(landmarks);
  EXPECT_EQ(poses.header.origin_ns, 77);
  EXPECT_EQ(poses.header.frame_id, 5u);
  EXPECT_EQ(lifter_->lift(landmarks).count, 0u) << "the same image says nothing new";
}

TEST_F(LiftTest, LandmarksOfNoHandGiveNoPose) {
  open("wave");
  const auto good = seen(1);
  auto few = good;
  for (std::size_t i = 7; i < 21; ++i) few.hands[0].points[i].confidence = 0;
  EXPECT_EQ(lifter_->lift(few).count, 0u);
  auto infinite = good;
  infinite.hands[0].points[3].x_px = std::numeric_limits<float>::infinity();
  EXPECT_EQ(lifter_->lift(infinite).count, 0u);
  auto together = good;
  for (auto& point : together.hands[0].points) point = {100, 100, 1, 0};
  EXPECT_EQ(lifter_->lift(together).count, 0u);
  EXPECT_EQ(lifter_->lift(msg::Landmarks{}).count, 0u);
  EXPECT_EQ(lifter_->lift(good).count, 1u) << "and they leave nothing behind";
}

TEST_F(LiftTest, NonsenseGivesNoPoseThatIsNotFinite) {
  open("wave");
  for (int i = 0; i < 300; ++i) {
    auto landmarks = seen(i * kStep_ns);
    for (std::size_t k = 0; k < 21; ++k) {
      landmarks.hands[0].points[k].x_px += static_cast<float>(((i * 37 + k * 101) % 997) - 498);
      landmarks.hands[0].points[k].y_px += static_cast<float>(((i * 53 + k * 71) % 991) - 495);
    }
    const auto poses = lifter_->lift(landmarks);
    for (const auto& joint : poses.hands[0].joints)
      for (const float value : joint.position_m) ASSERT_TRUE(std::isfinite(value));
  }
  EXPECT_EQ(lifter_->lift(seen(300 * kStep_ns)).count, 1u) << "a hand is lifted again";
}

}  // namespace
}  // namespace handcast::pose
