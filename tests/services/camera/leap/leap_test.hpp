// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "services/camera/camera.hpp"
#include "tests/emulation/under_umockdev.hpp"
#include "tests/services/camera/leap/emulated_leap.hpp"
#include "tests/services/camera/leap/sample_calibration.hpp"

namespace handcast::test {

inline std::uint32_t total(const msg::FrameLosses& lost) {
  return lost.missing + lost.incomplete + lost.underrun + lost.skipped;
}

/// The number in an image of the emulated controller.
inline std::uint32_t number_in(const msg::CameraFrame& frame) {
  std::uint32_t number = 0;
  for (int i = 3; i >= 0; --i) number = number << 8 | frame.pixels()[i];
  return number;
}

/// Tells the images of two starts of the stream apart. On a busy machine the emulated controller
/// may be silent for so long that the driver opens it again.
inline constexpr std::uint32_t kPerStart = 1'000'000;
inline bool are_of_one_start(std::uint32_t number, std::uint32_t other) {
  return number / kPerStart == other / kPerStart;
}

/// Opens the back end `leap` for an emulated controller, and captures images of both eyes.
class LeapTest : public testing::Test {
 protected:
  LeapTest() {
    rig_.camera.backend = "leap";
    rig_.camera.rate_hz = 115;
    rig_.camera.exposure_ms = 2;
    calibration_.camera.width_px = kWidth;
    calibration_.camera.height_px = kHeight;
    if (!sees_emulated()) return;
    device_ = std::make_unique<EmulatedLeap>([](LeapModel& model) {
      model.calibration = sample_calibration();
      model.numbers_per_start = kPerStart;
    });
  }
  void SetUp() override {
    if (!sees_emulated()) GTEST_SKIP() << "umockdev-wrapper is not installed, or a sanitizer is on";
  }
  static bool sees_emulated() { return sees_emulated_devices(); }

  Result<void> open() {
    camera_.reset();
    auto opened = camera::open_camera(rig_, calibration_, epoch_ns_);
    if (!opened) return tl::make_unexpected(opened.error());
    camera_ = std::move(*opened);
    return {};
  }
  /// The camera is refused with a sentence that has these parts.
  void expect_refused(Errc code, std::initializer_list<std::string_view> parts) {
    const auto refused = open();
    ASSERT_FALSE(refused);
    const auto& what = refused.error().what;
    EXPECT_EQ(refused.error().code, code) << what;
    EXPECT_TRUE(what.starts_with("camera 'leap': ")) << what;
    for (const auto part : parts) EXPECT_NE(what.find(part), std::string::npos) << what;
  }
  Result<void> capture(std::chrono::nanoseconds within = std::chrono::seconds(10)) {
    frame().lost = {};
    return camera_->capture_both(frame(), second(), kPixels, Deadline::in(within));
  }
  /// Captures until there is an image. The last error, if there was one.
  Error capture_again(std::chrono::nanoseconds within = std::chrono::seconds(20)) {
    Error last{Errc::timeout, ""};
    for (const auto until = Deadline::in(within); !until.passed();) {
      const auto captured = capture(std::chrono::milliseconds(20));
      if (captured) return last;
      last = captured.error();
    }
    ADD_FAILURE() << "no image: " << last.what;
    return last;
  }
  /// Both images of an exposure are whole, and of the right eye each.
  void expect_whole() {
    const auto number = number_in(frame());
    EXPECT_EQ(number_in(second()), number);
    const auto is_all = [](const msg::CameraFrame& image, std::uint8_t value) {
      return std::all_of(image.pixels() + 4, image.pixels() + kPixels,
                         [value](std::uint8_t pixel) { return pixel == value; });
    };
    EXPECT_TRUE(is_all(frame(), LeapModel::left_of(number)));
    EXPECT_TRUE(is_all(second(), LeapModel::right_of(number)));
  }

  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }
  msg::CameraFrame& second() { return *reinterpret_cast<msg::CameraFrame*>(second_.data()); }

  static constexpr int kWidth = 640, kHeight = 240;
  static constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::int64_t epoch_ns_ = now_ns();
  std::vector<std::byte> memory_{msg::CameraFrame::bytes(kWidth, kHeight)};
  std::vector<std::byte> second_{msg::CameraFrame::bytes(kWidth, kHeight)};
  std::unique_ptr<EmulatedLeap> device_;
  std::unique_ptr<camera::Camera> camera_;  ///< closed before its device is unplugged
};

}  // namespace handcast::test
