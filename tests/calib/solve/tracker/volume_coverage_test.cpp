// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/volume_coverage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

namespace handcast::calib {
namespace {

using ::testing::HasSubstr;

const CameraModel kCamera;

/// A flat hand of 21 points within 6 x 12 cm at a depth, seen in the middle of a field of the
/// image. `turn_rad`: about its long axis. The tracker's frame is anywhere.
std::vector<SeenPoint> hand_at(const glm::dvec2& middle_px, double depth_m, double turn_rad = 0) {
  std::vector<SeenPoint> hand;
  const glm::dmat4 tracker_from_camera = glm::translate(
      glm::rotate(glm::dmat4(1), 1.2, glm::normalize(glm::dvec3(1, 2, 3))), {0.5, -2, 1});
  const glm::dvec3 middle_m =
      depth_m * glm::dvec3((middle_px.x - kCamera.cx_px) / kCamera.fx_px,
                           (middle_px.y - kCamera.cy_px) / kCamera.fy_px, 1);
  for (int i = 0; i < 21; ++i) {
    const double across_m = 0.02 * (i % 4) - 0.03, along_m = 0.12 * i / 20 - 0.06;
    const auto at_m = middle_m + glm::dvec3(across_m * std::cos(turn_rad), along_m,
                                            across_m * std::sin(turn_rad));
    hand.push_back({kCamera.project(at_m), tracker_from_camera * glm::dvec4(at_m, 1)});
  }
  return hand;
}

VolumeCoverage empty() { return {kCamera, 0.5, 0.95}; }

void visit(VolumeCoverage& coverage, int column, int row, double depth_m) {
  for (int i = 0; i < 30; ++i) {
    auto hand = hand_at({120 + 240 * column, 90 + 180 * row}, depth_m);
    for (auto& point : hand)  // all of it in this field
      point.undistorted_px = glm::clamp(point.undistorted_px, glm::dvec2(240 * column, 180 * row),
                                        glm::dvec2(239 + 240 * column, 179 + 180 * row));
    coverage.add(hand);
  }
}

TEST(DepthBySize, IsThatOfTheHandWhereverTheTrackerIs) {
  for (const double depth_m : {0.5, 0.7, 1.0}) {
    EXPECT_NEAR(depth_by_size_m(kCamera, hand_at({300, 200}, depth_m)), depth_m, 0.02);
    EXPECT_NEAR(depth_by_size_m(kCamera, hand_at({300, 200}, depth_m, 1.4)), depth_m, 0.05)
        << "from its edge";
  }
}

TEST(DepthBySize, IsNoneOfTooFewPoints) {
  EXPECT_EQ(depth_by_size_m(kCamera, {}), 0);
  auto hand = hand_at({300, 200}, 0.7);
  EXPECT_EQ(depth_by_size_m(kCamera, std::span(hand).first(4)), 0);
  for (auto& point : hand) point.tracker_m = {NAN, 0, 0};
  EXPECT_EQ(depth_by_size_m(kCamera, hand), 0);
}

TEST(VolumeCoverage, CountsCellsThatWereVisitedForAWhile) {
  auto coverage = empty();
  EXPECT_EQ(coverage.share(), 0);
  coverage.add(hand_at({360, 270}, 0.6));
  EXPECT_EQ(coverage.share(), 0);
  visit(coverage, 1, 1, 0.6);
  EXPECT_NEAR(coverage.share(), 1 / 27., 1e-9);
}

TEST(VolumeCoverage, TellsWhereToMoveTheHandUntilAllIsCovered) {
  auto coverage = empty();
  EXPECT_EQ(coverage.advice(), "Move the hand near the camera (0.6 m).");
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      visit(coverage, column, row, 0.6);
      visit(coverage, column, row, 0.7);
      if (row != 2 || column != 0) visit(coverage, column, row, 0.9);
    }
  EXPECT_EQ(coverage.advice(),
            "Move the hand to the bottom left of the image, far from the camera (0.9 m).");
  visit(coverage, 0, 2, 0.9);
  EXPECT_EQ(coverage.share(), 1);
  EXPECT_EQ(coverage.advice(), "The volume is covered.");
}

TEST(VolumeCoverage, PointsOutsideTheVolumeDoNotCount) {
  auto coverage = empty();
  for (int i = 0; i < 100; ++i) {
    coverage.add(hand_at({-200, 100}, 0.6));
    coverage.add(hand_at({100, 800}, 0.6));
    coverage.add(hand_at({300, 200}, 0.46));
    coverage.add(hand_at({300, 200}, 1.0));
    auto hand = hand_at({300, 200}, 0.6);
    for (auto& point : hand) point.undistorted_px.x = NAN;
    coverage.add(hand);
  }
  EXPECT_EQ(coverage.share(), 0);
}

}  // namespace
}  // namespace handcast::calib
