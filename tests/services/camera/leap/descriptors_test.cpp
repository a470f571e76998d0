// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/descriptors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/camera/leap/transfer.hpp"
#include "tests/services/camera/leap/leap_model.hpp"

namespace handcast::camera::leap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The class-specific descriptors of an interface of the emulated controller.
std::vector<std::uint8_t> class_bytes(int interface) {
  const auto all = test::LeapModel().configuration();
  std::vector<std::uint8_t> bytes;
  int current = -1;
  for (std::size_t at = 0; at < all.size(); at += all[at]) {
    if (all[at + 1] == 4) current = all[at + 2];
    if (current == interface && all[at + 1] == 0x24)
      bytes.insert(bytes.end(), all.begin() + static_cast<std::ptrdiff_t>(at),
                   all.begin() + static_cast<std::ptrdiff_t>(at + all[at]));
  }
  return bytes;
}

TEST(LeapDescriptors, SizesRatesAndTheClockAreRead) {
  const auto read = parse_descriptors(class_bytes(0), class_bytes(1));
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->clock_hz, 1000u);
  ASSERT_EQ(read->modes.size(), 6u);
  const auto mode = mode_of(*read, 640, 240, 115);
  ASSERT_TRUE(mode);
  EXPECT_NEAR(mode->rate_hz, 115, 0.01);
  EXPECT_EQ(mode->frame, 2);
  EXPECT_EQ(mode->bytes(), 640u * 240 * 2);
}

TEST(LeapDescriptors, ARateThatIsTooHighForAllRowsIsThatOfAPartOfThem) {
  const auto read = parse_descriptors(class_bytes(0), class_bytes(1)).value();
  EXPECT_EQ(mode_of(read, 640, 480, 57.5)->height_px, 480);
  EXPECT_EQ(mode_of(read, 640, 480, 115)->height_px, 240);
  EXPECT_EQ(mode_of(read, 640, 480, 200)->height_px, 120);
  EXPECT_EQ(mode_of(read, 640, 480, 500)->height_px, 240) << "none is fast enough";
  EXPECT_EQ(mode_of(read, 640, 240, 115)->height_px, 240);
  EXPECT_EQ(mode_of(read, 640, 240, 200)->height_px, 120);
  EXPECT_EQ(mode_of(read, 640, 120, 500)->height_px, 120);
}

TEST(LeapDescriptors, ASizeThatIsNotThereIsRefusedWithThoseThatAre) {
  const auto read = parse_descriptors(class_bytes(0), class_bytes(1));
  const auto mode = mode_of(*read, 720, 540, 115);
  ASSERT_FALSE(mode);
  EXPECT_EQ(mode.error().code, Errc::bad_config);
  EXPECT_THAT(mode.error().what, AllOf(HasSubstr("720x540"), HasSubstr("640x240 at 115 Hz")));
}

TEST(LeapDescriptors, WhatIsCutOffOrOfNoUseIsSaid) {
  auto cut = class_bytes(1);
  cut.pop_back();
  EXPECT_THAT(parse_descriptors({}, cut).error().what,
              HasSubstr("a descriptor of 30 bytes, of which 29 are there"));
  const std::vector<std::uint8_t> stuck{0, 0x24, 5};
  EXPECT_FALSE(parse_descriptors(stuck, class_bytes(1)));
  EXPECT_THAT(parse_descriptors({}, {}).error().what, HasSubstr("no images"));
}

TEST(LeapTransfers, SettingsBecomeControls) {
  const StreamMode mode{.width_px = 640, .height_px = 240, .rate_hz = 115, .ticks = 86956};
  config::Leap settings;
  settings.gain = 32;
  settings.led_centre = false;
  const auto transfers = transfers_of(settings, 1.85, mode);
  ASSERT_TRUE(transfers);
  test::LeapModel model;
  for (const auto& one : *transfers) {
    const std::array<std::uint8_t, 8> setup{one.request_type,
                                            one.request,
                                            static_cast<std::uint8_t>(one.value),
                                            static_cast<std::uint8_t>(one.value >> 8),
                                            static_cast<std::uint8_t>(one.index),
                                            static_cast<std::uint8_t>(one.index >> 8),
                                            static_cast<std::uint8_t>(one.length),
                                            0};
    EXPECT_TRUE(model.control(setup, one.data));
  }
  EXPECT_EQ((model.controls[{2, 0x0b}]), 1850) << "us";
  EXPECT_EQ((model.controls[{5, 0x04}]), 32);
  EXPECT_EQ(transfers->at(5).data, (std::vector<std::uint8_t>{3, 0})) << "the middle LED is off";
  EXPECT_EQ(transfers->at(6).data, (std::vector<std::uint8_t>{4 | 0x40, 0}));
}

TEST(LeapTransfers, AnExposureLongerThanThePeriodIsRefused) {
  const StreamMode mode{.width_px = 640, .height_px = 240, .rate_hz = 115, .ticks = 86956};
  const auto transfers = transfers_of({}, 9, mode);
  ASSERT_FALSE(transfers);
  EXPECT_EQ(transfers.error().code, Errc::bad_config);
  EXPECT_THAT(transfers.error().what, AllOf(HasSubstr("exposure_ms"), HasSubstr("8.696")));
}

TEST(LeapTransfers, AnAnswerOfAnotherModeIsRefused) {
  const StreamMode mode{
      .width_px = 640, .height_px = 240, .rate_hz = 115, .ticks = 86956, .format = 1, .frame = 2};
  auto answer = probe(mode).data;
  answer[23] = 0x40;
  EXPECT_EQ(payload_bytes_of(answer, mode).value(), 0x4000u);
  answer[3] = 4;
  EXPECT_THAT(payload_bytes_of(answer, mode).error().what, HasSubstr("does not accept 640x240"));
  EXPECT_FALSE(payload_bytes_of(std::span(answer).first(25), mode));
}

}  // namespace
}  // namespace handcast::camera::leap
