// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/width_meter.hpp"

#include <gtest/gtest.h>

#include "renderer/skin/bone_fit.hpp"
#include "renderer/skin/skinning.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"

/// @file
/// A person's hand as a mask, seen from above without perspective, and the mean hand drawn on the
/// same joints.

namespace handcast::renderer {
namespace {

constexpr int kSize_px = 640;
constexpr float kPxPerM = 2600;
constexpr std::int64_t kFrame_ns = 2'000'000;

glm::vec2 seen_px(const glm::vec3& place_m) {
  return {320 + kPxPerM * place_m.x, 560 + kPxPerM * place_m.z};
}

std::vector<glm::vec2> seen_px(const std::vector<glm::vec3>& places_m) {
  std::vector<glm::vec2> px;
  for (const auto& place : places_m) px.push_back(seen_px(place));
  return px;
}

float turn(glm::vec2 a, glm::vec2 b) { return a.x * b.y - a.y * b.x; }

Image<std::uint8_t> mask_of(const HandMesh& hand) {
  Image<std::uint8_t> mask(kSize_px, kSize_px);
  const auto px = seen_px(hand.positions);
  for (const auto& [i, j, k] : hand.triangles) {
    const glm::vec2 a = px[i], b = px[j], c = px[k];
    const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    for (int y = std::max(0, int(low.y)); y <= std::min(kSize_px - 1, int(high.y) + 1); ++y)
      for (int x = std::max(0, int(low.x)); x <= std::min(kSize_px - 1, int(high.x) + 1); ++x) {
        const glm::vec2 p(x, y);
        const float u = turn(b - a, p - a), v = turn(c - b, p - b), w = turn(a - c, p - c);
        if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) mask.at(x, y) = 255;
      }
  }
  return mask;
}

class WidthMeterTest : public testing::Test {
 protected:
  const HandMesh mean_ = make_hand(HandShape::mean(), Side::left);
  WidthMeter meter_{mean_};
  BoneFit fit_{mean_};
  std::int64_t time_ns_ = 10'000'000'000;

  HandMesh person(float width) const {
    return refit_hand(mean_, HandShape::mean().scaled({1, 1, 1, 1, 1}, 1, width));
  }

  LandmarkPoints landmarks() const {
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i)
      points[i] = seen_px(glm::vec3(mean_.rest[msg::kJointOfLandmark[i]][3]));
    return points;
  }

  /// Measures frames of a still hand, each drawn with the present factor.
  void look_at(const Image<std::uint8_t>& mask, int frames) {
    for (int i = 0; i < frames; ++i, time_ns_ += kFrame_ns) {
      fit_.widen(meter_.factor());
      std::vector<glm::vec3> positions(mean_.vertex_count());
      skin(mean_, fit_(mean_.rest), positions);
      meter_.measure(time_ns_, seen_px(positions), landmarks(), mask.view());
    }
  }
};

TEST_F(WidthMeterTest, LearnsHowWideThePersonsFingersAre) {
  for (const float width : {0.94f, 1.0f, 1.14f}) {
    meter_ = WidthMeter(mean_);
    look_at(mask_of(person(width)), 150);
    EXPECT_NEAR(meter_.factor(), width, 0.035) << width;
  }
}

TEST_F(WidthMeterTest, HardlyMakesFingersThinner) {
  look_at(mask_of(person(0.8f)), 150);
  EXPECT_NEAR(meter_.factor(), 0.93, 0.001);
}

TEST_F(WidthMeterTest, OneFingerThatIsMeasuredWrongDoesNotCount) {
  auto mask = mask_of(person(1.1f));
  // The index finger is covered in part: a dark band along its middle phalanx.
  const glm::vec2 from = landmarks()[6], to = landmarks()[7];
  for (int i = 0; i <= 100; ++i)
    for (int x = 6; x < 40; ++x) {
      const glm::ivec2 at(glm::mix(from, to, float(i) / 100));
      mask.at(at.x + x, at.y) = 0;
    }
  look_at(mask, 150);
  EXPECT_NEAR(meter_.factor(), 1.1, 0.04);
}

TEST_F(WidthMeterTest, ChangesNothingBeforeItHasSeenEnough) {
  look_at(mask_of(person(1.14f)), 5);
  EXPECT_EQ(meter_.factor(), 1);
}

TEST_F(WidthMeterTest, NeverMakesTheLightTwitch) {
  const auto mask = mask_of(person(1.14f));
  for (int i = 0; i < 100; ++i) {
    const float before = meter_.factor();
    look_at(mask, 1);
    EXPECT_LE(std::abs(meter_.factor() - before), 0.0051f);
  }
}

TEST_F(WidthMeterTest, AnEmptyOrAFullMaskTeachesNothing) {
  look_at(Image<std::uint8_t>(kSize_px, kSize_px), 100);
  EXPECT_EQ(meter_.factor(), 1);
  look_at(Image<std::uint8_t>(kSize_px, kSize_px, 255), 100);
  EXPECT_EQ(meter_.factor(), 1);
}

TEST_F(WidthMeterTest, AnotherPersonIsLearnedAfreshAndWithoutAJump) {
  look_at(mask_of(person(1.14f)), 150);
  const float before = meter_.factor();
  time_ns_ += 1'500'000'000;
  look_at(mask_of(person(0.96f)), 1);
  EXPECT_EQ(meter_.factor(), before);
  look_at(mask_of(person(0.96f)), 150);
  EXPECT_NEAR(meter_.factor(), 0.96, 0.035);
}

TEST_F(WidthMeterTest, WhatMovesFastIsNotMeasured) {
  const auto mask = mask_of(person(1.14f));
  LandmarkPoints points = landmarks();
  for (int i = 0; i < 100; ++i, time_ns_ += kFrame_ns) {
    for (auto& point : points) point.x += 2;  // 1000 px/s
    meter_.measure(time_ns_, seen_px(mean_.positions), points, mask.view());
  }
  EXPECT_EQ(meter_.factor(), 1);
}

}  // namespace
}  // namespace handcast::renderer
