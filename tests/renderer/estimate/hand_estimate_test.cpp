// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/hand_estimate.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "renderer/base/joint_math.hpp"
#include "renderer/estimate/articulated_hand.hpp"
#include "renderer/predict/projected_pose.hpp"
#include "tests/renderer/hand_pose.hpp"
#include "tests/renderer/poses.hpp"

/// @file
/// A hand 0.6 m from the camera that opens and closes. Its tracker reports it 100 times a second,
/// wrongly; its landmarks are exact unless a test says otherwise.

namespace handcast::renderer {
namespace {

constexpr std::int64_t kStep_ns = 10'000'000;
constexpr float kSigma_px = 2, kLasts_s = 0.35f;  ///< of a landmark; how long its error lasts

glm::vec3 at(const msg::HandPose& pose, int landmark) {
  return position(pose.joints[static_cast<std::size_t>(msg::kJointOfLandmark[landmark])]);
}

/// Mean distance of the landmarks' joints, mm.
float apart_mm(const msg::HandPose& a, const msg::HandPose& b) {
  float sum = 0;
  for (int i = 0; i < kLandmarks; ++i) sum += glm::distance(at(a, i), at(b, i));
  return 1e3f * sum / kLandmarks;
}

/// A tracker or a detector that takes the index finger for the middle finger, and the reverse.
/// @{
msg::HandPose swapped(msg::HandPose pose) {
  std::swap_ranges(&pose.joints[6], &pose.joints[11], &pose.joints[11]);
  return pose;
}
msg::HandLandmarks swapped(msg::HandLandmarks seen) {
  std::swap_ranges(&seen.points[5], &seen.points[9], &seen.points[9]);
  return seen;
}
/// @}

class Estimate : public ::testing::Test {
 protected:
  /// The hand at a time: the fingers fold and unfold in a second.
  msg::HandPose truth(std::int64_t time_ns, glm::mat4 wrong = glm::mat4(1), float bent = 1) const {
    const auto fold = static_cast<float>(0.5 - 0.5 * std::cos(6.28e-9 * double(time_ns)));
    samples::Pose pose = samples::kPinch;
    for (auto& finger : pose.fingers)
      for (int i = 1; i < 4; ++i) finger[i] *= bent * (0.4f + 0.6f * fold);
    auto joints = samples::posed(mesh_, pose);
    for (auto& joint : joints) joint = glm::translate(glm::mat4(1), {0, 0.05f, 0}) * wrong * joint;
    return pose_of(Side::left, joints);
  }
  msg::HandLandmarks seen(const msg::HandPose& pose, float noise_px = 0) {
    const auto px = project_landmarks(calibration_, pose).value();
    std::normal_distribution<float> normal;
    const float kept = std::exp(-1e-9f * float(kStep_ns) / kLasts_s),
                renewed = std::sqrt(1 - kept * kept);
    msg::HandLandmarks seen;
    for (int i = 0; i < kLandmarks; ++i) {
      noise_[i] = kept * noise_[i] + renewed * glm::vec2(normal(random_), normal(random_));
      const glm::vec2 at = px[i] + noise_px * noise_[i];
      seen.points[i] = {at.x, at.y, 1, sigma_px_};
    }
    return seen;
  }
  void report(const msg::HandPose& pose) { track_.push(time_ns_, time_ns_, pose); }
  /// Seconds of a tracker that reports the hand turned or shifted, its fingers less or more bent.
  void follow(double seconds, const glm::mat4& wrong, float bent = 1, float noise_px = 0) {
    for (const auto end_ns = time_ns_ + std::int64_t(1e9 * seconds); time_ns_ < end_ns;
         time_ns_ += kStep_ns) {
      report(truth(time_ns_, wrong, bent));
      estimate_.detection(time_ns_, seen(truth(time_ns_), noise_px));
      estimate_.look_back(track_);
    }
    time_ns_ -= kStep_ns;
  }
  /// Seconds in which the tracker or the detector takes two fingers for each other.
  void follow_wrong(double seconds, bool is_tracker, bool is_detector) {
    for (const auto end_ns = time_ns_ + std::int64_t(1e9 * seconds); time_ns_ < end_ns;
         time_ns_ += kStep_ns) {
      const auto pose = truth(time_ns_);
      report(is_tracker ? swapped(pose) : pose);
      estimate_.detection(time_ns_, is_detector ? swapped(seen(pose)) : seen(pose));
      estimate_.look_back(track_);
    }
    time_ns_ -= kStep_ns;
  }
  /// The middle finger bent more, by so much at each of its joints.
  msg::HandPose snapped(const msg::HandPose& pose, float rad) const {
    HandErrors errors{};
    for (int b = 0; b < kBendsOfFinger; ++b) errors[error::bend_of(2, b)] = rad;
    const ArticulatedHand hand(in_camera(calibration_, pose), errors);
    return in_tracker(calibration_, hand.joints(), pose);
  }
  void see(const msg::HandPose& reported, const msg::HandPose& in_image) {
    report(reported);
    estimate_.detection(time_ns_, seen(in_image));
    estimate_.look_back(track_);
  }
  /// By how much the last bone of the middle finger is turned.
  static double turned_deg(const msg::HandPose& a, const msg::HandPose& b) {
    const auto bone = joint_of_landmark(11);
    return glm::degrees(angle_between(orientation(a.joints[bone]), orientation(b.joints[bone])));
  }
  /// Mean distance of the landmarks in the image, px.
  float apart_px(const msg::HandPose& a, const msg::HandPose& b) const {
    const auto one = project_landmarks(calibration_, a).value(),
               other = project_landmarks(calibration_, b).value();
    float sum = 0;
    for (int i = 0; i < kLandmarks; ++i) sum += glm::distance(one[i], other[i]);
    return sum / kLandmarks;
  }
  msg::HandPose corrected(const msg::HandPose& pose) const {
    return estimate_.corrected(time_ns_, pose);
  }

  std::mt19937 random_{5};
  LandmarkPoints noise_{};  ///< in standard deviations
  float sigma_px_ = kSigma_px;
  const HandMesh mesh_ = *load_hand_or_default({}, Side::left);
  const calib::Calibration calibration_ = [] {
    calib::Calibration calibration;
    calibration.camera_from_tracker =
        glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.05, 0.6, 1});
    return calibration;
  }();
  std::int64_t time_ns_ = 10'000'000'000;
  HandTrack track_{config::Predict{}, calibration_};
  HandEstimate estimate_{calibration_};
};

TEST_F(Estimate, KnowsNothingAtFirst) {
  EXPECT_FALSE(estimate_.knows());
  const auto pose = truth(time_ns_);
  EXPECT_LT(apart_mm(estimate_.corrected(time_ns_, pose), pose), 1e-3f);
}

TEST_F(Estimate, AShiftOfTheTrackerIsFound) {
  const auto wrong = glm::translate(glm::mat4(1), {0.012f, 0, 0.008f});
  follow(2, wrong);
  const auto reported = truth(time_ns_, wrong);
  EXPECT_LT(apart_mm(corrected(reported), truth(time_ns_)),
            0.2f * apart_mm(reported, truth(time_ns_)));
}

TEST_F(Estimate, ATurnOfTheTrackerIsFound) {
  const auto wrong = glm::rotate(glm::mat4(1), 0.05f, {0, 1, 0});  // in the image
  follow(2, wrong);
  const auto reported = truth(time_ns_, wrong);
  EXPECT_LT(apart_mm(corrected(reported), truth(time_ns_)),
            0.3f * apart_mm(reported, truth(time_ns_)));
}

TEST_F(Estimate, FingersAreBentAsTheLandmarksShow) {
  follow(2, glm::mat4(1), 0.7f);
  const auto reported = truth(time_ns_, glm::mat4(1), 0.7f);
  EXPECT_LT(apart_mm(corrected(reported), truth(time_ns_)),
            0.5f * apart_mm(reported, truth(time_ns_)));
}

// Derivatives that share the noise of the landmarks let the hand grow by 10 mm in 6 s.
TEST_F(Estimate, NoiseOfLandmarksDoesNotAddUp) {
  follow(2, glm::mat4(1), 1, kSigma_px);
  EXPECT_LT(apart_mm(corrected(truth(time_ns_)), truth(time_ns_)), 3);
  follow(30, glm::mat4(1), 1, kSigma_px);
  EXPECT_LT(apart_mm(corrected(truth(time_ns_)), truth(time_ns_)), 3);
  EXPECT_LT(std::abs(estimate_.errors_at(time_ns_)[error::kSize]), 0.02);
}

TEST_F(Estimate, AWrongLandmarkMovesTheHandLittle) {
  follow(1, glm::mat4(1));
  for (int i = 0; i < 20; ++i) {
    time_ns_ += kStep_ns;
    report(truth(time_ns_));
    auto wrong = seen(truth(time_ns_));
    wrong.points[8].x_px += 80;
    estimate_.detection(time_ns_, wrong);
    estimate_.look_back(track_);
  }
  const auto hand = corrected(truth(time_ns_)), right = truth(time_ns_);
  for (const int landmark : {0, 5, 9, 12, 16, 20})
    EXPECT_LT(1e3f * glm::distance(at(hand, landmark), at(right, landmark)), 3) << landmark;
  EXPECT_LT(1e3f * glm::distance(at(hand, 8), at(right, 8)), 12);  // 80 px are 41 mm
}

// Not by bends, which would turn the joints beyond it, too.
TEST_F(Estimate, AJointThatDriftsByItselfIsPutBackAndTheOthersStay) {
  follow(1, glm::mat4(1));
  auto reported = truth(time_ns_);
  const auto joint = msg::kJointOfLandmark[6];
  for (int i = 1; i <= 60; ++i) {
    time_ns_ += kStep_ns;
    reported = truth(time_ns_);
    reported.joints[joint].position_m[0] += 1e-4f * static_cast<float>(i);
    report(reported);
    estimate_.detection(time_ns_, seen(truth(time_ns_)));
    estimate_.look_back(track_);
  }
  const auto hand = corrected(reported), right = truth(time_ns_);
  for (const int landmark : {5, 6, 7, 8, 12})
    EXPECT_LT(1e3f * glm::distance(at(hand, landmark), at(right, landmark)), 2) << landmark;
}

/// A detector defines joints in its own way, and the less sure it is the more.
TEST_F(Estimate, AJointThatAnUnsureDetectorSeesElsewhereStays) {
  constexpr int kKnuckle = 9;
  constexpr float kBeside_px = 6;
  const auto moved_mm = [&](float sigma_px) {
    sigma_px_ = sigma_px;
    estimate_ = HandEstimate(calibration_);
    for (int i = 0; i < 1500; ++i, time_ns_ += kStep_ns) {
      report(truth(time_ns_));
      auto landmarks = seen(truth(time_ns_));
      landmarks.points[kKnuckle].x_px += kBeside_px;
      estimate_.detection(time_ns_, landmarks);
      estimate_.look_back(track_);
    }
    time_ns_ -= kStep_ns;
    const auto pose = truth(time_ns_);
    return 1e3f * glm::distance(at(corrected(pose), kKnuckle), at(pose, kKnuckle));
  };
  const float sure_mm = moved_mm(2), unsure_mm = moved_mm(12);
  EXPECT_LT(unsure_mm, 0.75f * sure_mm);
}

/// Another person's flesh does to a detector the same at all fingers.
TEST_F(Estimate, ARowOfJointsThatTheDetectorSeesElsewhereStays) {
  constexpr float kTowardsTip = 0.2f;  // of a bone
  float elsewhere_mm = 0, moved_mm = 0;
  for (int i = 0; i < 500; ++i, time_ns_ += kStep_ns) {
    const auto pose = truth(time_ns_);
    auto as_seen = pose;
    for (const int middle : {6, 10, 14, 18}) {
      const auto place = glm::mix(at(pose, middle), at(pose, middle + 1), kTowardsTip);
      for (int axis = 0; axis < 3; ++axis)
        as_seen.joints[joint_of_landmark(middle)].position_m[axis] = place[axis];
    }
    report(pose);
    estimate_.detection(time_ns_, seen(as_seen));
    estimate_.look_back(track_);
    elsewhere_mm += apart_mm(as_seen, pose);
    moved_mm += apart_mm(corrected(pose), pose);
  }
  EXPECT_LT(moved_mm, 0.7f * elsewhere_mm);
}

TEST_F(Estimate, AFingerThatTheTrackerTakesForAnotherIsWhereTheLandmarksAre) {
  follow(1, glm::mat4(1));
  follow_wrong(0.6, true, false);
  EXPECT_LT(apart_px(corrected(swapped(truth(time_ns_))), truth(time_ns_)), 3);
  follow(0.04, glm::mat4(1));
  EXPECT_LT(apart_px(corrected(truth(time_ns_)), truth(time_ns_)), 2);
}

TEST_F(Estimate, AFingerThatTheTrackerSnapsStaysBentAsItIs) {
  follow(1, glm::mat4(1));
  for (const float snap_rad : {0.3f, 0.f}) {  // there and back
    for (int i = 0; i < 3; ++i) {
      time_ns_ += kStep_ns;
      see(snapped(truth(time_ns_), snap_rad), truth(time_ns_));
      EXPECT_LT(turned_deg(corrected(snapped(truth(time_ns_), snap_rad)), truth(time_ns_)), 8)
          << snap_rad << ", image " << i;
    }
  }
}

TEST_F(Estimate, AFingerThatBothSeeBendAbruptlyIsBent) {
  follow(1, glm::mat4(1));
  for (int i = 0; i < 3; ++i) {
    time_ns_ += kStep_ns;
    const auto bent = snapped(truth(time_ns_), 0.3f);
    see(bent, bent);
    EXPECT_LT(turned_deg(corrected(bent), bent), 3) << "image " << i;
  }
}

TEST_F(Estimate, AHandRestsWhileItsLandmarksDo) {
  const auto still = truth(time_ns_);
  for (int i = 0; i < 100; ++i, time_ns_ += kStep_ns) {
    report(truth(time_ns_));
    estimate_.detection(time_ns_, seen(still, 0.2f));
    estimate_.look_back(track_);
  }
  EXPECT_EQ(estimate_.rest().share, 1);
  EXPECT_EQ(estimate_.rest().since_ns, time_ns_ - kStep_ns);
  follow(0.3, glm::mat4(1));
  EXPECT_EQ(estimate_.rest().share, 0);
}

TEST_F(Estimate, AFingerThatTheDetectorTakesForAnotherStaysWhereTheTrackerIs) {
  follow(1, glm::mat4(1));
  follow_wrong(0.3, false, true);
  EXPECT_LT(apart_px(corrected(truth(time_ns_)), truth(time_ns_)), 4);
  follow(0.04, glm::mat4(1));
  EXPECT_LT(apart_px(corrected(truth(time_ns_)), truth(time_ns_)), 2);
}

TEST_F(Estimate, ATrackerThatLosesTheHandLittleByLittleIsTrustedAgainWhenItHasIt) {
  const auto away = [](double share) {
    return glm::translate(glm::mat4(1), {0.15f * static_cast<float>(share), 0, 0});
  };
  follow(1, glm::mat4(1));
  for (int i = 0; i < 60; ++i) {
    time_ns_ += kStep_ns;
    follow(0.01, away(i / 60.0));
  }
  time_ns_ += kStep_ns;
  follow(0.04, glm::mat4(1));
  EXPECT_TRUE(estimate_.knows());
  EXPECT_LT(apart_mm(corrected(truth(time_ns_)), truth(time_ns_)), 2);
}

TEST_F(Estimate, ATrackerThatWasMovedIsLearnedAnew) {
  const auto moved = glm::translate(glm::mat4(1), {0.08f, 0, 0});
  follow(1, glm::mat4(1));
  follow(2, moved);
  EXPECT_TRUE(estimate_.knows());
  EXPECT_LT(apart_mm(corrected(truth(time_ns_, moved)), truth(time_ns_)), 4);
}

TEST_F(Estimate, LandmarksThatWereNotSeenDoNotCount) {
  follow(1, glm::mat4(1));
  const auto step = [this](bool is_seen) {
    time_ns_ += kStep_ns;
    report(truth(time_ns_, glm::mat4(1), 0.7f));
    auto partly = seen(truth(time_ns_));
    if (!is_seen)
      for (int i = 5; i < kLandmarks; ++i)
        partly.points[i] = {-1000, std::numeric_limits<float>::quiet_NaN(), 0, 0};
    estimate_.detection(time_ns_, partly);
    estimate_.look_back(track_);
  };
  const auto off_mm = [this] {
    return apart_mm(corrected(truth(time_ns_, glm::mat4(1), 0.7f)), truth(time_ns_));
  };
  for (int i = 0; i < 100; ++i) step(false);
  const float before_mm = off_mm();
  step(true);
  EXPECT_LT(off_mm(), 0.5f * before_mm);
}

TEST_F(Estimate, LandmarksWaitForTheTrackersNextSample) {
  report(truth(time_ns_));
  estimate_.detection(time_ns_ + kStep_ns / 2, seen(truth(time_ns_ + kStep_ns / 2)));
  estimate_.look_back(track_);
  EXPECT_FALSE(estimate_.knows());
  time_ns_ += kStep_ns;
  report(truth(time_ns_));
  estimate_.look_back(track_);
  EXPECT_TRUE(estimate_.knows());
}

TEST_F(Estimate, LandmarksOfBeforeAJumpOfTheTrackerAreNotUsed) {
  report(truth(time_ns_));
  estimate_.detection(time_ns_ + kStep_ns / 2, seen(truth(time_ns_)));
  time_ns_ += 500'000'000;
  report(truth(time_ns_));
  estimate_.look_back(track_);
  EXPECT_FALSE(estimate_.knows());
}

TEST_F(Estimate, AfterAJumpOfTheTrackerItsPlaceIsLearnedAnew) {
  follow(2, glm::translate(glm::mat4(1), {0.012f, 0, 0.008f}));
  estimate_.tracker_jumped();
  EXPECT_FALSE(estimate_.knows());
  const auto elsewhere = glm::translate(glm::mat4(1), {-0.05f, 0, 0.02f});
  time_ns_ += 500'000'000;  // or the track, too, would take it for a jump
  follow(0.1, elsewhere);
  EXPECT_LT(apart_px(corrected(truth(time_ns_, elsewhere)), truth(time_ns_)), 3) << "in the image";
  follow(3, elsewhere);
  EXPECT_LT(apart_mm(corrected(truth(time_ns_, elsewhere)), truth(time_ns_)), 4)
      << "its depth, too";
}

TEST_F(Estimate, WhatIsNotSeenAnyMoreFadesAndWhatLastsStays) {
  const auto shifted = glm::translate(glm::mat4(1), {0.012f, 0, 0});
  follow(2, shifted, 0.7f);
  const auto reported = truth(time_ns_, shifted, 0.7f);
  const auto bend_of = [](const msg::HandPose& pose) {
    return angle_between(orientation(pose.joints[7]), orientation(pose.joints[9]));
  };
  const auto later = estimate_.corrected(time_ns_ + 10'000'000'000, reported);
  EXPECT_NEAR(bend_of(later), bend_of(reported), 0.15);
  EXPECT_LT(glm::distance(at(later, 0), at(truth(time_ns_), 0)), 0.005f);
}

TEST_F(Estimate, ItStaysFiniteWhateverIsSeen) {
  follow(0.2, glm::mat4(1));
  std::uniform_real_distribution<float> anywhere(-9e4f, 9e4f);
  for (int i = 0; i < 200; ++i) {
    time_ns_ += kStep_ns;
    report(truth(time_ns_));
    auto wild = seen(truth(time_ns_));
    for (auto& point : wild.points)
      point = {anywhere(random_), anywhere(random_), 1, std::abs(anywhere(random_))};
    estimate_.detection(time_ns_, wild);
    estimate_.look_back(track_);
    for (const double value : estimate_.errors_at(time_ns_)) ASSERT_TRUE(std::isfinite(value)) << i;
  }
  follow(3, glm::mat4(1));
  EXPECT_LT(apart_mm(corrected(truth(time_ns_)), truth(time_ns_)), 4);
}

}  // namespace
}  // namespace handcast::renderer
