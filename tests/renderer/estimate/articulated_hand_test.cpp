// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/articulated_hand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "renderer/base/joint_math.hpp"
#include "tests/renderer/hand_pose.hpp"
#include "tests/renderer/poses.hpp"

namespace handcast::renderer {
namespace {

calib::Calibration calibration() {
  calib::Calibration calibration;
  calibration.camera_from_tracker =
      glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.05, 0.6, 1});
  return calibration;
}

class Articulated : public ::testing::TestWithParam<Side> {
 protected:
  msg::HandPose pose(const samples::Pose& of) const {
    return pose_of(GetParam(), samples::posed(mesh_, of));
  }
  HandJoints joints(const samples::Pose& of) const { return in_camera(calibration_, pose(of)); }

  const HandMesh mesh_ = *load_hand_or_default({}, GetParam());
  const calib::Calibration calibration_ = calibration();
};
INSTANTIATE_TEST_SUITE_P(Sides, Articulated, ::testing::Values(Side::left, Side::right),
                         [](const auto& each) {
                           return each.param == Side::left ? "left" : "right";
                         });

/// Small errors of all kinds.
HandErrors drawn_errors() {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  HandErrors errors{};
  for (std::size_t i = 0; i < error::kSeen; ++i)
    errors[i] = (i < error::kTurn || i >= error::kDrift ? 0.004 : 0.05) * normal(random);
  return errors;
}

TEST_P(Articulated, AHandWithoutErrorsIsTheReportedOne) {
  const auto reported = pose(samples::kPinch);
  const auto same = in_tracker(
      calibration_, ArticulatedHand(joints(samples::kPinch), HandErrors{}).joints(), reported);
  for (std::size_t j = 0; j < reported.joints.size(); ++j) {
    EXPECT_LT(glm::distance(position(same.joints[j]), position(reported.joints[j])), 1e-6f);
    EXPECT_LT(angle_between(orientation(same.joints[j]), orientation(reported.joints[j])), 1e-3f);
  }
}

TEST_P(Articulated, FlexionIsWhatAFingerIsBentBy) {
  const auto flexions = flexions_of(joints(samples::kFist));
  const auto straight = flexions_of(joints(samples::kOpen));
  for (int finger = 1; finger < kFingers; ++finger)
    for (int b = 0; b < kBendsOfFinger; ++b) {
      const double asked = glm::radians(samples::kFist.fingers[finger - 1][b + 1]);
      EXPECT_NEAR(flexions[finger][b], asked, straight[finger][b] + 0.06) << finger << ' ' << b;
    }
}

TEST_P(Articulated, JointsAtOnePlaceAreAHandThatIsNotBent) {
  auto reported = joints(samples::kPinch);
  reported.at_m.fill({0.1, 0, 0.6});
  EXPECT_EQ(flexions_of(reported), Flexions{});
  const ArticulatedHand hand(reported, drawn_errors());
  for (const auto& at_m : hand.joints().at_m) EXPECT_TRUE(std::isfinite(at_m.x + at_m.y + at_m.z));
}

TEST_P(Articulated, APositiveBendFoldsAFinger) {
  HandErrors errors{};
  for (int b = 0; b < kBendsOfFinger; ++b) errors[error::bend_of(2, b)] = 0.3;
  const auto open = joints(samples::kPinch);
  const auto before = flexions_of(open);
  const auto after = flexions_of(ArticulatedHand(open, errors).joints());
  for (int b = 0; b < kBendsOfFinger; ++b) EXPECT_NEAR(after[2][b] - before[2][b], 0.3, 0.02);
  EXPECT_NEAR(after[1][0], before[1][0], 1e-9);
}

TEST_P(Articulated, ErrorsDoNotChangeTheLengthsOfBones) {
  auto errors = drawn_errors();
  for (std::size_t i = error::kDrift; i < error::kSeen; ++i) errors[i] = 0;
  errors[error::kSize] = 0;
  const auto reported = joints(samples::kPinch);
  const auto hand = ArticulatedHand(reported, errors).joints();
  for (const int joint : {3, 4, 5, 8, 9, 10, 13, 20, 25}) {
    const auto j = static_cast<std::size_t>(joint);
    EXPECT_NEAR(glm::distance(hand.at_m[j], hand.at_m[j - 1]),
                glm::distance(reported.at_m[j], reported.at_m[j - 1]), 1e-9);
  }
}

/// The place at which a detector is expected to see a landmark.
glm::dvec3 seen_at(const HandJoints& reported, const HandErrors& errors, int landmark) {
  return ArticulatedHand(reported, errors).joints().at_m[joint_of_landmark(landmark)];
}

/// The derivatives of a landmark's place by all errors.
std::array<glm::dvec3, error::kCount> slopes_of(const ArticulatedHand& hand, int landmark) {
  std::array<glm::dvec3, error::kCount> slopes{};
  hand.derivatives(
      landmark,
      [&](std::size_t first, const glm::dmat3& slope) {
        for (int i = 0; i < 3; ++i) slopes[first + static_cast<std::size_t>(i)] += slope[i];
      },
      [&](std::size_t index, const glm::dvec3& slope) { slopes[index] += slope; });
  return slopes;
}

/// Compares derivatives with differences for the errors from `first` to `end`.
void expect_slopes(const HandJoints& reported, const HandErrors& errors, std::size_t first,
                   std::size_t end) {
  constexpr double kStep = 1e-6;
  const ArticulatedHand hand(reported, errors);
  for (int landmark = 0; landmark < kLandmarks; ++landmark) {
    const auto slopes = slopes_of(hand, landmark);
    for (std::size_t i = first; i < end; ++i) {
      // The centre about which another joint bends moves, too: of second order, and left out.
      if (i >= error::kPlace && i - error::place_of(landmark) > 2) continue;
      auto more = errors, less = errors;
      more[i] += kStep;
      less[i] -= kStep;
      const auto measured =
          (seen_at(reported, more, landmark) - seen_at(reported, less, landmark)) / (2 * kStep);
      EXPECT_LT(glm::distance(slopes[i], measured), 1e-6)
          << "landmark " << landmark << ", error " << i;
    }
  }
}

TEST_P(Articulated, DerivativesAreThoseOfThePlacesOfLandmarks) {
  expect_slopes(joints(samples::kPinch), HandErrors{}, 0, error::kRow);
}

TEST_P(Articulated, DerivativesOfAPostureAreThoseOfTheEstimatedOne) {
  auto errors = drawn_errors();
  std::fill(errors.begin() + error::kPlace, errors.end(), 0);  // they turn with the joints a little
  expect_slopes(joints(samples::kPinch), errors, error::kBend, error::kDrift);
}

}  // namespace
}  // namespace handcast::renderer
