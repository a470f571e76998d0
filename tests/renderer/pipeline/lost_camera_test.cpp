// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/renderer/pipeline/driven_pipeline.hpp"

namespace handcast::renderer {
namespace {

/// The lit pixels of a still hand at 600 ms; the last image is of another hand elsewhere.
int lit_with_image_of(std::int64_t image_ns) {
  const auto calibration = rig_above_hand();
  const auto hand = pose_of(Side::left);
  const auto image = image_of(calibration, {hand}, {90, 60});
  const auto pipeline = make_pipeline();
  feed_still(*pipeline, {hand}, 600 * kMs);
  int lit = 0;
  for (std::int64_t now_ns = 604 * kMs; now_ns < 760 * kMs; now_ns += 4 * kMs) {
    pipeline->push(now_ns, poses_of(now_ns - 9 * kMs, {hand}));
    const TimedImage camera{image.view(), image_ns < 0 ? now_ns - 3 * kMs : image_ns};
    lit = lit_pixels(pipeline->render(now_ns, now_ns + 4 * kMs, image_ns ? camera : TimedImage{}));
  }
  return lit;
}

TEST(LostCamera, TheLightFollowsTheTrackerWhenTheLastImageIsOld) {
  const int without = lit_with_image_of(0);
  EXPECT_GT(without, 20'000);
  EXPECT_EQ(lit_with_image_of(400 * kMs), without) << "a quarter of a second ago and more";
  EXPECT_LT(lit_with_image_of(-1), without * 3 / 4) << "a new one cuts the light";
}

}  // namespace
}  // namespace handcast::renderer
