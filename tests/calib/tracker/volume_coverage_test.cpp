// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/volume_coverage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace handcast::calib {
namespace {

using ::testing::HasSubstr;

/// A tracker that looks like the camera, 0.5 m to the left and 1 m behind it.
const glm::dmat4 kCameraFromTracker{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5, 0, -1, 1};
const CameraModel kCamera;

glm::dvec3 at_depth(double depth_m) { return {0.5, 0, 1 + depth_m}; }

VolumeCoverage empty() { return {kCamera, kCameraFromTracker, 0.5, 0.95}; }

void visit(VolumeCoverage& coverage, int column, int row, double depth_m) {
  for (int i = 0; i < 30; ++i)
    coverage.add({120 + 240 * column, 90 + 180 * row}, at_depth(depth_m));
}

TEST(VolumeCoverage, CountsCellsThatWereVisitedForAWhile) {
  auto coverage = empty();
  EXPECT_EQ(coverage.share(), 0);
  coverage.add({360, 270}, at_depth(0.6));
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
    coverage.add({-1, 100}, at_depth(0.6));
    coverage.add({100, 540}, at_depth(0.6));
    coverage.add({100, 100}, at_depth(0.49));
    coverage.add({100, 100}, at_depth(0.96));
    coverage.add({NAN, 100}, at_depth(0.6));
    coverage.add({100, 100}, {NAN, NAN, NAN});
  }
  EXPECT_EQ(coverage.share(), 0);
}

}  // namespace
}  // namespace handcast::calib
