// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "services/landmarks/models/mediapipe_palms.hpp"

namespace handcast::landmarks {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// An open hand, fingers up, its wrist at (0, 0), its palm `palm_px` long.
Points open_hand(float palm_px) {
  Points points{};
  for (int finger = 0; finger < 5; ++finger)
    for (int k = 0; k < 4; ++k)
      points[1 + 4 * finger + k] = palm_px * glm::vec2(0.25f * static_cast<float>(2 - finger),
                                                       -1.0f - 0.3f * static_cast<float>(k));
  return points;
}

Points placed(Points points, glm::vec2 at_px, float angle_rad) {
  for (auto& point : points) point = at_px + turned(point, angle_rad);
  return points;
}

TEST(MediapipeRegion, AHandThatPointsUpIsNotTurned) {
  EXPECT_NEAR(mediapipe_region_of_landmarks(placed(open_hand(100), {300, 400}, 0)).angle_rad, 0,
              1e-4);
}

TEST(MediapipeRegion, TurnsAndMovesWithTheHand) {
  const Region upright = mediapipe_region_of_landmarks(placed(open_hand(100), {300, 400}, 0));
  for (const float angle_rad : {0.4f, -1.2f, kPi / 2, 3.0f}) {
    const Region region =
        mediapipe_region_of_landmarks(placed(open_hand(100), {300, 400}, angle_rad));
    EXPECT_NEAR(std::remainder(region.angle_rad - angle_rad, 2 * kPi), 0, 1e-4);
    EXPECT_NEAR(region.size_px, upright.size_px, 0.01);
    const glm::vec2 expected =
        glm::vec2(300, 400) + turned(upright.centre_px - glm::vec2(300, 400), angle_rad);
    EXPECT_NEAR(glm::distance(region.centre_px, expected), 0, 0.02);
  }
}

TEST(MediapipeRegion, HoldsTheWholeHandUpright) {
  const Points points = placed(open_hand(120), {500, 380}, 2.2f);
  const Region region = mediapipe_region_of_landmarks(points);
  for (const auto& point : points) {
    const glm::vec2 place = region.to_place(point);
    EXPECT_LT(std::max(std::abs(place.x), std::abs(place.y)), 0.5f);
  }
  EXPECT_LT(region.to_place(points[12]).y, region.to_place(points[0]).y)
      << "the fingers are above the wrist";
}

}  // namespace
}  // namespace handcast::landmarks
