// SPDX-License-Identifier: Apache-2.0
#include "services/camera/v4l2/loss_count.hpp"

#include <gtest/gtest.h>

namespace handcast::camera::v4l2 {
namespace {

TEST(LossCount, TheFirstImageHasLostNothing) {
  LossCount count(40);
  EXPECT_EQ(count.arrived(7), 40u);
  EXPECT_EQ(count.take().missing, 0u);
}

TEST(LossCount, AGapIsMissing) {
  LossCount count(0);
  count.arrived(0);
  EXPECT_EQ(count.arrived(4), 4u);
  EXPECT_EQ(count.take().missing, 3u);
  EXPECT_EQ(count.take().missing, 0u) << "it is reported once";
}

TEST(LossCount, AGapAfterAllBuffersWereFullIsAnUnderrun) {
  LossCount count(0);
  count.arrived(0);
  count.all_were_full();
  count.arrived(4);
  const auto lost = count.take();
  EXPECT_EQ(lost.underrun, 3u);
  EXPECT_EQ(lost.missing, 0u);
}

TEST(LossCount, NumbersGoOnWhenTheDriversNumberWraps) {
  LossCount count(0);
  count.arrived(UINT32_MAX);
  EXPECT_EQ(count.arrived(1), 2u);
  EXPECT_EQ(count.take().missing, 1u);
}

TEST(LossCount, ADriverThatDoesNotCountLosesNothing) {
  LossCount count(0);
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(count.arrived(0), i);
  EXPECT_EQ(count.take().missing, 0u);
}

}  // namespace
}  // namespace handcast::camera::v4l2
