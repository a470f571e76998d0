// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/finger_outline.hpp"

#include <gtest/gtest.h>

#include "tests/renderer/correct/seen_hand.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kFrame_ns = 2'000'000;
constexpr int kIndex = 5, kMiddle = 9;

class FingerOutlineTest : public testing::Test {
 protected:
  const SeenHand& hand_ = SeenHand::mean();
  FingerOutline outline_{hand_.mesh};
  std::int64_t time_ns_ = 10'000'000'000;

  /// The landmarks with a finger displaced from its first joint (nothing) to its tip (all).
  LandmarkPoints displaced(int finger, glm::vec2 tip_px) const {
    LandmarkPoints px = hand_.landmarks_px;
    const std::array<float, 4> share{0, 0.45f, 0.75f, 1};
    for (int k = 0; k < 4; ++k) px[finger + k] += share[k] * tip_px;
    return px;
  }

  /// Draws and measures frames of a hand whose landmarks are seen at `landmarks`.
  void look_at(const Image<std::uint8_t>& mask, int frames, const LandmarkPoints& landmarks) {
    for (int i = 0; i < frames; ++i, time_ns_ += kFrame_ns) {
      const LandmarkPoints drawn = outline_.moved(landmarks);
      outline_.measure(time_ns_, hand_.moved_to(drawn), drawn, mask.view());
    }
  }
  void look_at(const Image<std::uint8_t>& mask, int frames) {
    look_at(mask, frames, hand_.landmarks_px);
  }

  glm::vec2 displacement(int landmark, const LandmarkPoints& landmarks) const {
    return outline_.moved(landmarks)[landmark] - landmarks[landmark];
  }
  glm::vec2 displacement(int landmark) const { return displacement(landmark, hand_.landmarks_px); }

  Image<std::uint8_t> mask_at(const LandmarkPoints& landmarks) const {
    return mask_of(hand_.mesh, hand_.moved_to(landmarks));
  }
};

TEST_F(FingerOutlineTest, AFingerBesideItsLandmarksIsMovedOntoTheMask) {
  const glm::vec2 aside(9, 0);
  look_at(mask_at(displaced(kIndex, aside)), 150);
  EXPECT_NEAR(displacement(kIndex + 3).x, 9, 2);
  EXPECT_NEAR(displacement(kIndex + 1).x, 4, 1.5);
  for (const int other : {kMiddle, 13, 17})
    for (int k = 0; k < 4; ++k)
      EXPECT_LT(glm::length(displacement(other + k)), 1.5f) << "landmark " << other + k;
}

TEST_F(FingerOutlineTest, AFingerThatIsLongerThanItsLandmarksSayReachesItsEnd) {
  look_at(mask_at(displaced(kMiddle, {0, -9})), 150);
  EXPECT_LT(displacement(kMiddle + 3).y, -6);
  EXPECT_GT(displacement(kMiddle + 3).y, -10);
}

TEST_F(FingerOutlineTest, WhatIsDrawnOnTheMaskStays) {
  look_at(mask_at(hand_.landmarks_px), 150);
  for (int i = 0; i < kLandmarks; ++i) EXPECT_LT(glm::length(displacement(i)), 1) << i;
}

TEST_F(FingerOutlineTest, AMaskThatMergesWithClutterOrShowsNothingTeachesNothing) {
  const auto stays = [&] {
    for (int i = 0; i < kLandmarks; ++i) EXPECT_EQ(displacement(i), glm::vec2(0)) << i;
  };
  look_at(Image<std::uint8_t>(kSize_px, kSize_px, 255), 100);
  stays();
  look_at(Image<std::uint8_t>(kSize_px, kSize_px), 100);
  stays();
  look_at(Image<std::uint8_t>(), 100);
  stays();
}

TEST_F(FingerOutlineTest, AFingerThatTouchesSomethingOnOneSideIsNotPulledThere) {
  auto mask = mask_at(hand_.landmarks_px);
  const glm::vec2 from = hand_.landmarks_px[kIndex + 1], to = hand_.landmarks_px[kIndex + 3];
  for (int y = int(to.y) - 30; y < int(from.y) + 20; ++y)
    for (int x = int(to.x); x < int(to.x) + 90; ++x) mask.at(x, y) = 255;
  look_at(mask, 150);
  EXPECT_LT(std::abs(displacement(kIndex + 2).x), 2);
}

TEST_F(FingerOutlineTest, AFingerFoldedBeforeThePalmIsNotPulledToThePalmsOutline) {
  LandmarkPoints folded = hand_.landmarks_px;
  folded[kIndex + 2] = folded[kIndex] + glm::vec2(4, 20);
  folded[kIndex + 3] = folded[kIndex] + glm::vec2(8, 60);
  auto mask = mask_at(folded);
  // The palm's border is as far from the finger's middle as the finger's own side would be.
  for (int y = int(folded[kIndex].y); y < kSize_px; ++y)
    for (int x = 0; x < kSize_px; ++x)
      if (x > int(folded[kIndex].x) + 36 || x < int(folded[kIndex].x) - 20) mask.at(x, y) = 0;
  look_at(mask, 150, folded);
  EXPECT_EQ(displacement(kIndex + 3, folded), glm::vec2(0));
}

TEST_F(FingerOutlineTest, WhatIsNoLongerSeenFades) {
  look_at(mask_at(displaced(kIndex, {9, 0})), 150);
  ASSERT_GT(displacement(kIndex + 3).x, 6);
  const auto nothing = Image<std::uint8_t>(kSize_px, kSize_px);
  look_at(nothing, 5);
  EXPECT_GT(displacement(kIndex + 3).x, 6);
  look_at(nothing, 1500);
  EXPECT_LT(std::abs(displacement(kIndex + 3).x), 0.5);
}

TEST_F(FingerOutlineTest, AHandSeenFromItsEdgeIsNotMeasured) {
  LandmarkPoints edge_on = hand_.landmarks_px, aside = displaced(kIndex, {9, 0});
  for (auto* points : {&edge_on, &aside})
    for (auto& point : *points) point.x = 320 + 0.4f * (point.x - 320);
  look_at(mask_at(aside), 150, edge_on);
  EXPECT_EQ(displacement(kIndex + 3, edge_on), glm::vec2(0));
}

TEST_F(FingerOutlineTest, WhatMovesFastIsNotMeasured) {
  const auto mask = mask_at(displaced(kIndex, {9, 0}));
  LandmarkPoints px = hand_.landmarks_px;
  look_at(mask_at(px), 2);
  for (int i = 0; i < 20; ++i) {
    for (auto& point : px) point.x += i % 2 == 0 ? 4.0f : -4.0f;  // 2000 px/s
    look_at(mask, 1, px);
  }
  EXPECT_LT(std::abs(displacement(kIndex + 3, px).x), 1);
}

TEST_F(FingerOutlineTest, ADrawingThatDoesNotFollowIsNotDisplacedFartherAndFarther) {
  for (const glm::vec2 tip_px : {glm::vec2(0, -9), glm::vec2(0, 9), glm::vec2(9, 0)}) {
    outline_ = FingerOutline(hand_.mesh);
    const auto mask = mask_at(displaced(kMiddle, tip_px));
    for (int i = 0; i < 1000; ++i, time_ns_ += kFrame_ns)
      outline_.measure(time_ns_, hand_.vertices_px, hand_.landmarks_px, mask.view());
    EXPECT_LT(glm::length(displacement(kMiddle + 3)), 20) << tip_px.x << ' ' << tip_px.y;
  }
}

TEST_F(FingerOutlineTest, TheLightDoesNotJump) {
  const auto mask = mask_at(displaced(kIndex, {9, 0}));
  look_at(mask_at(hand_.landmarks_px), 50);
  float largest_px = 0;
  for (int i = 0; i < 150; ++i) {
    const LandmarkPoints before = outline_.moved(hand_.landmarks_px);
    look_at(mask, 1);
    const LandmarkPoints after = outline_.moved(hand_.landmarks_px);
    for (int k = 0; k < kLandmarks; ++k)
      largest_px = std::max(largest_px, glm::distance(before[k], after[k]));
  }
  EXPECT_GT(displacement(kIndex + 3).x, 6) << "it has moved";
  EXPECT_LT(largest_px, 0.5f) << "a frame of 2 ms is a twentieth of the memory of 40 ms";
}

}  // namespace
}  // namespace handcast::renderer
