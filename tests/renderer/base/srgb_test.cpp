// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/srgb.hpp"

#include <gtest/gtest.h>

namespace handcast::renderer {
namespace {

TEST(Srgb, LevelAndLightAreInverse) {
  for (int level = 0; level < 256; ++level)
    ASSERT_NEAR(255 * srgb_level(srgb_light(level / 255.)), level, 1e-6);
  EXPECT_NEAR(srgb_light(0.5), 0.2140, 1e-4);
}

TEST(Srgb, TheFastLevelIsNearTheExactOne) {
  EXPECT_EQ(fast_srgb_level(0), 0);
  for (int i = 0; i <= 10'000; ++i) {
    const double light = i / 10'000.;
    ASSERT_NEAR(fast_srgb_level(static_cast<float>(light)), srgb_level(light),
                light < 0.005 ? 0.04 : 0.003)
        << light;
  }
}

}  // namespace
}  // namespace handcast::renderer
