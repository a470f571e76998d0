// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "services/tools/init/candidate.hpp"
#include "tests/services/tools/init/some_devices.hpp"

namespace handcast::init {
namespace {

TEST(Fitting, TheFastestFormatOfTheCalibratedSizeIsTaken) {
  const auto images = fastest(colour_webcam().modes, {1280, 720});
  ASSERT_TRUE(images);
  EXPECT_EQ(images->format, "MJPEG");
  EXPECT_EQ(images->rate_hz, 30);
  EXPECT_FALSE(fastest(colour_webcam().modes, {720, 540}));
}

TEST(Fitting, OfEquallyFastFormatsTheFirstIsTaken) {
  const auto images =
      fastest({mode(640, 480, 30, "GREY"), mode(640, 480, 30, "MJPEG")}, {640, 480});
  ASSERT_TRUE(images);
  EXPECT_EQ(images->format, "GREY");
}

TEST(Fitting, AnySizeOfARangeFits) {
  const auto modes = industrial_camera().modes;
  EXPECT_EQ(fastest(modes, {320, 200})->rate_hz, 525);
  EXPECT_FALSE(fastest(modes, {721, 540}));
  EXPECT_FALSE(fastest(modes, {16, 16}));
}

TEST(Fitting, WithoutACalibrationRateCountsMoreThanSizeButNotBelow640x480) {
  const auto best = [](std::vector<devices::Mode> modes) { return recommended(modes).size; };
  EXPECT_EQ(best(colour_webcam().modes), (Size{640, 480})) << "nearest to 720x540 at 30 Hz";
  EXPECT_EQ(best({mode(320, 240, 187), mode(640, 480, 75), mode(1920, 1080, 30)}),
            (Size{640, 480}));
  EXPECT_EQ(best({mode(160, 120, 60), mode(640, 360, 15)}), (Size{640, 360}))
      << "all are small: the largest";
  EXPECT_EQ(best({{"", 16, 16, 1920, 1200, 160}}), (Size{720, 540})) << "a region of the sensor";
}

}  // namespace
}  // namespace handcast::init
