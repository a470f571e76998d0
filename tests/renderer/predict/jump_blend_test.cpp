// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/jump_blend.hpp"

#include <gtest/gtest.h>

#include "tests/milliseconds.hpp"

namespace handcast::renderer {
namespace {

constexpr float kSpeed_px_ms = 1;

LandmarkPoints at_x(float x_px) {
  LandmarkPoints points;
  points.fill({x_px, 0});
  return points;
}

/// A hand at constant speed. From 100 to 200 ms its landmarks are smoothed by follow() and 6 px
/// ahead.
struct HandOver {
  float offset_px(int ms) const { return ms >= 100 && ms < 200 ? 6.0f : 0.0f; }
  float step(JumpBlend& blend, int ms) const {
    const auto wanted = at_x(kSpeed_px_ms * static_cast<float>(ms) + offset_px(ms));
    const bool alone = ms >= 100 && ms < 200;
    if (alone) return blend.follow(ms * kMs, wanted, ms == 100)[0].x;
    return blend.smooth(ms * kMs, wanted, at_x(kSpeed_px_ms * static_cast<float>(ms - 1)))[0].x;
  }
};

TEST(JumpBlend, ARowThatGoesOverFromOneSourceToAnotherAndBackDoesNotJump) {
  const HandOver hand;
  JumpBlend blend(6, 8);
  float before = hand.step(blend, 1);
  for (int ms = 2; ms < 300; ++ms) {
    const float now = hand.step(blend, ms);
    EXPECT_NEAR(now - before, kSpeed_px_ms, 0.16f * 6) << ms;
    if (ms % 100 > 40 || ms < 100) {
      EXPECT_NEAR(now, kSpeed_px_ms * static_cast<float>(ms) + hand.offset_px(ms), 0.02f) << ms;
    }
    before = now;
  }
}

TEST(JumpBlend, WithoutNewsNothingIsHeldBack) {
  JumpBlend blend(6, 8);
  for (int ms = 0; ms < 50; ++ms)
    EXPECT_EQ(blend.follow(ms * kMs, at_x(static_cast<float>(ms * ms)), false)[0].x, ms * ms);
}

}  // namespace
}  // namespace handcast::renderer
