// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "services/camera/camera.hpp"
#include "tests/services/camera/v4l2/emulated_webcam.hpp"

namespace handcast::test {

/// A small webcam with every format in 64x48 and 33x17.
inline EmulatedWebcam::Description small_webcam() {
  EmulatedWebcam::Description description;
  for (const std::uint32_t code : {V4L2_PIX_FMT_MJPEG, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_NV12,
                                   V4L2_PIX_FMT_Y10, V4L2_PIX_FMT_Y16, V4L2_PIX_FMT_GREY})
    description.formats.push_back({.code = code,
                                   .sizes = {{64, 48, {30, 60, 100, 250}}, {33, 17, {100}}},
                                   .padding = code == V4L2_PIX_FMT_MJPEG ? 0u : 5u});
  description.controls = webcam_controls();
  return description;
}

/// Opens the back end `v4l2` for a webcam, and captures images.
class WebcamTest : public testing::Test {
 protected:
  WebcamTest() {
    rig_.camera.backend = "v4l2";
    rig_.camera.rate_hz = 100;
    rig_.camera.exposure_ms = 2;
    calibration_.camera.width_px = 64;
    calibration_.camera.height_px = 48;
  }

  /// Opens the camera; the test fails if it is refused.
  bool open() {
    camera_.reset();
    auto opened = camera::open_camera(rig_, calibration_, epoch_ns_);
    if (opened) camera_ = std::move(*opened);
    EXPECT_TRUE(opened) << opened.error().what;
    return opened.has_value();
  }
  void expect_refused(Errc code, const testing::Matcher<std::string>& sentence) {
    camera_.reset();
    const auto refused = camera::open_camera(rig_, calibration_, epoch_ns_);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, code) << refused.error().what;
    EXPECT_THAT(refused.error().what, sentence);
    EXPECT_TRUE(refused.error().what.starts_with("camera 'v4l2': ")) << refused.error().what;
  }
  std::size_t pixels() const {
    return static_cast<std::size_t>(calibration_.camera.width_px) * calibration_.camera.height_px;
  }
  Result<void> capture(std::chrono::nanoseconds span = std::chrono::seconds(10)) {
    memory_.resize(msg::CameraFrame::bytes(64, 48));
    return camera_->capture(frame(), pixels(), Deadline::in(span));
  }
  /// Captures until an image comes or an error other than a timeout or bad data.
  Result<void> capture_patiently() {
    const auto until = Deadline::in(std::chrono::seconds(30));
    for (;;) {
      auto captured = capture(std::chrono::milliseconds(50));
      if (captured || until.passed() || captured.error().code == Errc::disconnected)
        return captured;
    }
  }
  msg::CameraFrame& frame() { return *reinterpret_cast<msg::CameraFrame*>(memory_.data()); }
  std::vector<std::uint8_t> grey() { return {frame().pixels(), frame().pixels() + pixels()}; }

  config::Rig rig_;
  calib::Calibration calibration_ = calib::reference_rig();
  std::int64_t epoch_ns_ = now_ns();
  std::unique_ptr<camera::Camera> camera_;

 private:
  std::vector<std::byte> memory_;
};

}  // namespace handcast::test
