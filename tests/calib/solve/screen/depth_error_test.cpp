// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/depth_error.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/calib/solve/screen/rendered_board.hpp"

namespace handcast::calib {
namespace {

constexpr std::array kDepths_m{0.63, 0.73, 0.83};

TEST(DepthError, IsNothingForACoaxialProjector) {
  const auto volume = coaxial_error(test::coaxial_screen(), test::bent_camera(), kDepths_m, 5, 4);
  EXPECT_EQ(volume.error_px, std::vector<double>(3 * 5 * 4, 0.));
}

TEST(DepthError, OfACoaxialHomographyGrowsWithTheDistanceFromItsPlane) {
  const auto screen = test::screen_beside(0.15);
  const auto volume = coaxial_error(screen, test::bent_camera(), kDepths_m, 3, 3);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      EXPECT_LT(volume.at(1, row, column), 1e-9);
      EXPECT_GT(volume.at(0, row, column), volume.at(2, row, column));
    }
  // The middle of the image, at 0.63 m instead of 0.73 m, seen from 0.15 m beside it.
  const double angle = std::atan(0.15 / 0.73);
  EXPECT_NEAR(volume.at(0, 1, 1), 1653 * std::tan(std::atan(0.15 / 0.63) - angle), 1e-6);
}

TEST(DepthError, SaysForEachDepthHowFarAModelIsOff) {
  const auto truth = test::screen_beside(0.15);
  auto believed = truth;
  believed.from_camera = glm::dmat3(1, 0, 0, 0, 1, 0, 2, 0, 1) * truth.from_camera;
  believed.parallax = glm::dmat3(1, 0, 0, 0, 1, 0, 2, 0, 1) * truth.parallax;
  const auto errors = depth_error(believed, truth, test::bent_camera(), kDepths_m);
  ASSERT_EQ(errors.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(errors[i].depth_m, kDepths_m[i]);
    EXPECT_NEAR(errors[i].median_px, 2, 1e-6);
    EXPECT_NEAR(errors[i].largest_px, 2, 1e-6);
  }
}

}  // namespace
}  // namespace handcast::calib
