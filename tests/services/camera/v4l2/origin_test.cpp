// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/origin.hpp"

#include <gtest/gtest.h>

#include "tests/milliseconds.hpp"

namespace handcast::camera::v4l2 {
namespace {

constexpr StreamTimes kStream{.exposure = {.time_ns = 4 * kMs, .error_ns = kMs / 10},
                              .delivery_ns = 3 * kMs,
                              .period_ns = 8 * kMs};

TEST(Origin, IsHalfAnExposureAfterItsStart) {
  const auto origin = origin_of({StampOf::exposure_start, 100 * kMs, 110 * kMs}, kStream);
  EXPECT_EQ(origin.time_ns, 102 * kMs);
  EXPECT_EQ(origin.error_ns, kMs / 20 + 1000);
}

TEST(Origin, IsTheDeliveryAndHalfAnExposureBeforeTheArrival) {
  const auto origin = origin_of({StampOf::arrival, 109 * kMs, 110 * kMs}, kStream);
  EXPECT_EQ(origin.time_ns, 104 * kMs);
  EXPECT_GE(origin.error_ns, kStream.period_ns);
}

TEST(Origin, IsCountedFromTheFetchIfTheStampIsOfAnotherClock) {
  const auto origin = origin_of({StampOf::nothing, 42, 110 * kMs}, kStream);
  EXPECT_EQ(origin.time_ns, 105 * kMs);
  EXPECT_GE(origin.error_ns, 2 * kStream.period_ns);
}

TEST(Origin, AStampThatCannotBeTrueIsNotUsed) {
  for (const std::int64_t stamp_ns : {5110 * kMs, 5000 * kMs - 1'001 * kMs, std::int64_t{0}})
    EXPECT_EQ(origin_of({StampOf::exposure_start, stamp_ns, 5000 * kMs}, kStream).time_ns,
              4995 * kMs)
        << stamp_ns;
}

}  // namespace
}  // namespace handcast::camera::v4l2
