// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/camera/v4l2/controls.hpp"

namespace handcast::camera::v4l2 {
namespace {

using testing::HasSubstr;

const Control kGain{.name = "gain", .least = 0, .most = 250, .step = 10};
const Control kLine{.kind = ControlKind::menu,
                    .name = "power_line_frequency",
                    .most = 2,
                    .menu = {{0, "Disabled"}, {2, "60 Hz"}}};
const Control kFlip{.kind = ControlKind::boolean, .name = "horizontal_flip", .most = 1};

void expect_refused(const Control& control, std::string_view text, const std::string& part) {
  const auto refused = value_for(control, text);
  ASSERT_FALSE(refused) << text;
  EXPECT_EQ(refused.error().code, Errc::bad_config);
  EXPECT_THAT(refused.error().what, HasSubstr(part));
}

TEST(Control, IsNamedAsV4l2CtlNamesIt) {
  EXPECT_EQ(kernel_name("Power Line Frequency"), "power_line_frequency");
  EXPECT_EQ(kernel_name("Exposure Time, Absolute"), "exposure_time_absolute");
  EXPECT_EQ(kernel_name("Exposure (Absolute)"), "exposure_absolute");
  EXPECT_EQ(kernel_name(" LED1 -- Mode "), "led1_mode");
  EXPECT_EQ(kernel_name("---"), "");
}

TEST(Control, ANumberIsRoundedToTheStep) {
  EXPECT_EQ(value_for(kGain, "0"), 0);
  EXPECT_EQ(value_for(kGain, "14"), 10);
  EXPECT_EQ(value_for(kGain, "16"), 20);
  EXPECT_EQ(value_for(kGain, "250"), 250);
}

TEST(Control, ANumberNearTheEndStaysOnTheLastStep) {
  const Control odd{.name = "odd", .least = 1, .most = 9, .step = 5};
  EXPECT_EQ(value_for(odd, "9"), 6);
  const Control widest{.name = "widest", .least = INT64_MIN, .most = INT64_MAX, .step = 2};
  EXPECT_EQ(value_for(widest, "9223372036854775807"), INT64_MAX - 1);
}

TEST(Control, ANumberOutOfRangeIsRefusedWithTheRange) {
  for (const auto* text : {"251", "-1", "", "a", "1.5", "99999999999999999999"})
    expect_refused(
        kGain, text,
        "gain cannot be '" + std::string(text) + "'; it accepts 0 to 250 in steps of 10");
}

TEST(Control, AMenuIsSetByIndexOrWord) {
  EXPECT_EQ(value_for(kLine, "2"), 2);
  EXPECT_EQ(value_for(kLine, "60 Hz"), 2);
  EXPECT_EQ(value_for(kLine, "60_hz"), 2);
  EXPECT_EQ(value_for(kLine, "disabled"), 0);
}

TEST(Control, AnEntryThatAMenuLacksIsRefusedWithTheMenu) {
  for (const auto* text : {"1", "3", "50 Hz", ""})
    expect_refused(kLine, text, "it accepts 0 (Disabled), 2 (60 Hz)");
}

TEST(Control, ABooleanIsANumberOrAWord) {
  EXPECT_EQ(value_for(kFlip, "1"), 1);
  EXPECT_EQ(value_for(kFlip, "true"), 1);
  EXPECT_EQ(value_for(kFlip, "false"), 0);
  expect_refused(kFlip, "2", "it accepts 0 to 1");
}

}  // namespace
}  // namespace handcast::camera::v4l2
