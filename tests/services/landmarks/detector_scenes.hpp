// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ipc/msg/owned.hpp"
#include "services/landmarks/detector.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/services/landmarks/pictures.hpp"

/// Frames for the tests of the detectors.
namespace handcast::landmarks {

/// Writes `count` detections of a left hand 10 ms apart; every coordinate of detection i is 100 +
/// i.
inline void write_detections(const std::filesystem::path& folder, std::size_t count) {
  std::vector<float> values;
  std::vector<std::int64_t> times_us;
  for (std::size_t i = 0; i < count; ++i) {
    values.insert(values.end(), 42, static_cast<float>(100 + i));
    times_us.push_back(static_cast<std::int64_t>(i) * 10'000);
  }
  ASSERT_TRUE(recording::write_npy_f32(folder / "landmarks_left.npy", {count, 21, 2}, values));
  ASSERT_TRUE(recording::write_npy_i64(folder / "landmarks_timestamps.npy", times_us));
}

/// A frame without pixels.
inline msg::CameraFrame frame_of(std::uint64_t id, std::int64_t origin_ns) {
  msg::CameraFrame frame;
  frame.header = {id, origin_ns, origin_ns};
  return frame;
}

/// A picture of a left hand as a camera frame, and a calibration for it.
struct Scene {
  msg::Owned<msg::CameraFrame> frame;
  calib::Calibration calibration = calib::reference_rig();
  Hints hints;

  explicit Scene(const test::Capture& capture)
      : frame(msg::CameraFrame::bytes(capture.image.width(), capture.image.height())),
        hints{capture.tracker_px, std::nullopt} {
    frame->width_px = capture.image.width();
    frame->height_px = capture.image.height();
    std::ranges::copy(capture.image.pixels(), frame->pixels());
    calibration.camera = {capture.image.width(), capture.image.height(), 1600, 1600, 511.5, 383.5};
  }
  const msg::CameraFrame& at(std::uint64_t id, std::int64_t origin_ns) {
    frame->header = {id, origin_ns, origin_ns};
    return *frame;
  }
};

}  // namespace handcast::landmarks
