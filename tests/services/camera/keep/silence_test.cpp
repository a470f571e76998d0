// SPDX-License-Identifier: Apache-2.0
#include "services/camera/keep/silence.hpp"

#include <gtest/gtest.h>

#include "tests/milliseconds.hpp"

namespace handcast::camera {
namespace {

TEST(Silence, IsTooLongAfterThreePeriodsButAtLeastFiftyMilliseconds) {
  EXPECT_EQ(Silence::patience_of(500), 50 * kMs);
  EXPECT_EQ(Silence::patience_of(10), 300 * kMs);
  const Silence silence(50 * kMs);
  const auto last_ns = now_ns() + 1000 * kMs;
  EXPECT_TRUE(silence.is_broken(last_ns));
  EXPECT_FALSE(silence.is_too_long(last_ns, last_ns + 50 * kMs));
  EXPECT_TRUE(silence.is_too_long(last_ns, last_ns + 51 * kMs));
}

TEST(Silence, TheFirstImageOfACameraMayTakeASecond) {
  const auto old_ns = now_ns() - 1;
  Silence silence(50 * kMs);
  silence.begin_again();
  EXPECT_FALSE(silence.is_broken(old_ns));
  EXPECT_FALSE(silence.is_too_long(old_ns, old_ns + 1000 * kMs));
  EXPECT_TRUE(silence.is_too_long(old_ns, now_ns() + 1001 * kMs));
}

}  // namespace
}  // namespace handcast::camera
