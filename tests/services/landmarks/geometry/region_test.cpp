// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/geometry/region.hpp"

#include <gtest/gtest.h>

#include "services/landmarks/geometry/points.hpp"

namespace handcast::landmarks {
namespace {

TEST(Region, PlacesAndPixelsAreInverse) {
  const Region region{{310, 222}, 187, 0.7f};
  const glm::vec2 place(0.31f, -0.22f);
  EXPECT_NEAR(glm::distance(region.to_place(region.to_image(place)), place), 0, 1e-5);
}

TEST(Region, OfAnImageReachesFromEdgeToEdgeOfItsLongerSide) {
  const Region whole = region_of_image(720, 540);
  EXPECT_NEAR(glm::distance(whole.to_image({-0.5f, 0}), {-0.5f, 269.5f}), 0, 1e-3);
  EXPECT_NEAR(glm::distance(whole.to_image({0.5f, 0}), {719.5f, 269.5f}), 0, 1e-3);
}

TEST(Points, AreFiniteOnlyIfEveryCoordinateIs) {
  Points points{};
  EXPECT_TRUE(is_finite(points));
  points[20].y = INFINITY;
  EXPECT_FALSE(is_finite(points));
  points[20] = {NAN, 0};
  EXPECT_FALSE(is_finite(points));
}

TEST(Points, AreAsFarFromTheirShiftedSelvesAsTheShiftIsLong) {
  Points points{};
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {3.0f * static_cast<float>(i), 7};
  EXPECT_NEAR(distance_px(points, shifted(points, {3, -4})), 5, 1e-4);
  EXPECT_NEAR(glm::distance(centre_of(points), {30, 7}), 0, 1e-4);
  EXPECT_NEAR(palm_length_px(points), 27, 1e-4);
}

}  // namespace
}  // namespace handcast::landmarks
