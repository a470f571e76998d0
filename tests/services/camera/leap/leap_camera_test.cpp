// SPDX-License-Identifier: Apache-2.0
// A controller while all goes well, and what is refused.
#include <gmock/gmock.h>

#include <fstream>

#include "services/camera/leap/controller.hpp"
#include "tests/services/camera/camera_contract.hpp"
#include "tests/services/camera/leap/leap_test.hpp"

namespace handcast::camera {
namespace {

using test::EmulatedLeap;
using test::LeapModel;
using test::number_in;
using test::total;
using testing::AllOf;
using testing::HasSubstr;

/// The row over a controller that is plugged in when it is first opened.
const CameraBackend& row_over_a_controller() {
  static constexpr auto kOpen = [](const Opening& with) {
    static EmulatedLeap device;
    return open_camera(with.rig, with.calibration, with.epoch_ns);
  };
  static const CameraBackend the_row = [] {
    auto row = *std::ranges::find(camera_backends(), "leap", &CameraBackend::name);
    row.open = kOpen;
    return row;
  }();
  return the_row;
}

class Leap : public test::LeapTest {};

TEST_F(Leap, BothEyesComeWholeAndInOrderAndNoneIsLostUncounted) {
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  auto last = number_in(frame());
  auto last_id = frame().header.frame_id;
  std::int64_t last_ns = frame().header.origin_ns;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(capture());
    expect_whole();
    const auto number = number_in(frame());
    EXPECT_EQ(frame().header.frame_id - last_id, total(frame().lost) + 1);
    if (test::are_of_one_start(number, last)) {
      EXPECT_EQ(total(frame().lost), number - last - 1);
    }
    EXPECT_GT(frame().header.origin_ns, last_ns);
    EXPECT_EQ(second().header.frame_id, frame().header.frame_id);
    EXPECT_EQ(second().header.origin_ns, frame().header.origin_ns);
    last = number;
    last_id = frame().header.frame_id;
    last_ns = frame().header.origin_ns;
  }
  EXPECT_EQ(frame().width_px, 640u);
  EXPECT_EQ(second().height_px, 240u);
  EXPECT_EQ(frame().exposure_ns, 2'000'000);
  const auto counts = device_->counts();
  EXPECT_EQ(counts.unknown, 0);
  EXPECT_GE(counts.detached, 2) << "both interfaces were the kernel's";
  EXPECT_GE(counts.most_waiting, 16) << "the controller can hold only a part of an image";
}

TEST_F(Leap, TheOriginIsTheMiddleOfTheExposure) {
  // Each is more than the limits of the error allow, and both less than the period of 8.7 ms.
  rig_.camera.exposure_ms = 6;
  rig_.camera.delivery_ms = 3;
  ASSERT_TRUE(open());
  std::vector<double> off_ms;
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(capture());
    const auto begun_ns = device_->with_model(
        [&](const LeapModel& model) { return model.begun_ns(number_in(frame())); });
    // The image is sent from the end of its exposure on, here without any delay.
    off_ms.push_back(ns_to_ms(frame().header.origin_ns - (begun_ns - 6'000'000)));
    EXPECT_LE(frame().header.origin_ns, now_ns());
  }
  // Not the median: a loaded machine sends and receives most of them late, and none early.
  std::ranges::nth_element(off_ms, off_ms.begin() + 30);
  std::printf("tenth percentile of the origins' errors: %.2f ms\n", off_ms[30]);
  EXPECT_GT(off_ms[30], -1) << "ms";
  EXPECT_LT(off_ms[30], 2) << "ms; the emulated transfers take about 1 ms";
  EXPECT_GT(frame().origin_error_ns, 0);
}

TEST_F(Leap, TheSettingsReachTheController) {
  rig_.camera.leap.gain = 40;
  rig_.camera.leap.digital_gain = 3;
  rig_.camera.leap.gamma = true;
  rig_.camera.leap.eye = config::Eye::right;
  ASSERT_TRUE(open());
  ASSERT_TRUE(capture());
  const auto number = number_in(frame());
  EXPECT_EQ(frame().pixels()[10], LeapModel::right_of(number));
  EXPECT_EQ(second().pixels()[10], LeapModel::left_of(number));
  device_->with_model([](LeapModel& model) {
    EXPECT_EQ((model.controls[{2, 0x0b}]), 2000);
    EXPECT_EQ((model.controls[{5, 4}]), 40);
    EXPECT_EQ((model.controls[{5, 2}]), 3);
    EXPECT_EQ((model.controls[{5, 9}]), 1);
  });
}

TEST_F(Leap, ItIsFoundByItsSerialNumberAndByItsPort) {
  for (const auto* name : {"LP53304172541", "1-2", ""}) {
    rig_.camera.leap.device = name;
    ASSERT_TRUE(open()) << name;
    EXPECT_TRUE(capture());
  }
  rig_.camera.leap.device = "LP0";
  camera_.reset();
  expect_refused(Errc::unavailable, {"no controller 'LP0'", "LP53304172541 (port 1-2)"});
}

TEST_F(Leap, WhatCannotWorkIsRefusedWithASentence) {
  calibration_.camera.width_px = 720;
  expect_refused(Errc::bad_config, {"640x240 at 115 Hz"});
  calibration_.camera.width_px = 640;
  rig_.camera.exposure_ms = 20;
  expect_refused(Errc::bad_config, {"exposure_ms"});
  rig_.camera.exposure_ms = 2;
  calibration_.camera_device = "another one";
  expect_refused(Errc::bad_config, {"another one"});
  calibration_.camera_device.clear();
  device_->with_model([](LeapModel& model) { model.refused = {5, 4}; });
  expect_refused(Errc::bad_data, {"refuses request 0x1"});
  device_->with_model([](LeapModel& model) { model.refused.reset(); });
  device_->hold(true);
  expect_refused(Errc::unavailable, {"another program uses"});
  device_->hold(false);
  EXPECT_TRUE(open());
}

TEST_F(Leap, WithoutAControllerItIsSaid) {
  device_.reset();
  expect_refused(Errc::unavailable, {"no Leap Motion Controller is attached"});
}

TEST_F(Leap, OldFirmwareIsBroughtUpByAFile) {
  device_->with_model([](LeapModel& model) { model.is_locked = true; });
  ASSERT_TRUE(open());
  EXPECT_FALSE(capture(2s));
  EXPECT_THAT(capture(100ms).error().what, HasSubstr("(leap.bring_up)"));
  camera_.reset();
  const test::Scratch scratch;
  const auto file = std::filesystem::path(scratch.path()) / "unlock.txt";
  std::ofstream(file) << "set 5 0a 1\npause 2\nread a1 81 0700 0500 2\n";
  rig_.camera.leap.bring_up = file;
  ASSERT_TRUE(open());
  EXPECT_TRUE(capture());
  std::ofstream(file) << "set 5\n";
  camera_.reset();
  expect_refused(Errc::bad_config, {"leap.bring_up", ":1: `set`"});
}

TEST_F(Leap, ACalibrationIsReadFromAController) {
  const auto text = leap::calibration_file_from("", false, 640, 240);
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_THAT(*text, AllOf(HasSubstr("LP53304172541"), HasSubstr("left eye's")));
}

// The last one: its controller stays plugged in.
INSTANTIATE_TEST_SUITE_P(Controller, CameraContract, testing::ValuesIn([] {
                           return test::sees_emulated_devices()
                                      ? std::vector{row_over_a_controller()}
                                      : std::vector<CameraBackend>{};
                         }()),
                         name_of_row);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CameraContract);

}  // namespace
}  // namespace handcast::camera
