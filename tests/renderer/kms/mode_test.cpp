// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "renderer/kms/display.hpp"

namespace handcast::renderer::kms {
namespace {

using testing::HasSubstr;

const std::vector<Mode> kModes{
    {1920, 1080, 60}, {1280, 800, 59.81}, {1280, 800, 120}, {1024, 768, 60}};

TEST(ChooseMode, IsByDefaultTheSizeOfTheProjectorAtTheNearestRate) {
  EXPECT_EQ(choose_mode(kModes, "", {1280, 800, 60}), 1u);
  EXPECT_EQ(choose_mode(kModes, "", {1280, 800, 946}), 2u);
  EXPECT_EQ(choose_mode(kModes, "", {1024, 768, 946}), 3u);
}

TEST(ChooseMode, TakesTheSizeInTheSettingsAtTheNearestRate) {
  EXPECT_EQ(choose_mode(kModes, "1920x1080", {1280, 800, 946}), 0u);
}

TEST(ChooseMode, TakesARateOnlyWhereItIsMeant) {
  EXPECT_EQ(choose_mode(kModes, "1280x800@60", {1280, 800, 946}), 1u) << "59.81 Hz";
  EXPECT_EQ(choose_mode(kModes, "1280x800@120", {1280, 800, 60}), 2u);
  const auto refused = choose_mode(kModes, "1280x800@75", {1280, 800, 60});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
  EXPECT_THAT(refused.error().what, HasSubstr("there is no mode 1280x800@75; it has 1920x1080@60, "
                                              "1280x800@59.81, 1280x800@120, 1024x768@60"));
}

TEST(ChooseMode, NamesTheSizeInTheCalibrationIfThereIsNoSuchMode) {
  const auto refused = choose_mode(kModes, "", {640, 480, 60});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("640x480, the size in the calibration"));
  EXPECT_THAT(choose_mode({}, "", {640, 480, 60}).error().what, HasSubstr("it lists no mode"));
}

TEST(ChooseMode, RefusesWhatIsNotAMode) {
  for (const auto* wanted : {"big", "1280", "1280x", "1280x800@", "1280x800@60Hz", "1280x800 "}) {
    const auto refused = choose_mode(kModes, wanted, {1280, 800, 60});
    ASSERT_FALSE(refused) << wanted;
    EXPECT_EQ(refused.error().code, Errc::bad_config) << wanted;
    EXPECT_THAT(refused.error().what, HasSubstr("WIDTHxHEIGHT@HZ"));
  }
}

TEST(ModeOf, HasTheRateOfItsPixelClock) {
  drmModeModeInfo timing{};
  timing.hdisplay = 1280;
  timing.vdisplay = 720;
  timing.htotal = 1650;
  timing.vtotal = 750;
  timing.clock = 74176;
  EXPECT_NEAR(mode_of(timing).rate_hz, 59.94, 0.001);
  EXPECT_EQ(describe(mode_of(timing)), "1280x720@59.94");
  timing.flags = DRM_MODE_FLAG_DBLSCAN;
  EXPECT_NEAR(mode_of(timing).rate_hz, 29.97, 0.001);
  EXPECT_EQ(mode_of({}).rate_hz, 0);
}

}  // namespace
}  // namespace handcast::renderer::kms
