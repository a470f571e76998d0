// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <utility>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/predict/pose_history.hpp"
#include "services/landmarks/geometry/points.hpp"

namespace handcast::landmarks {

/// The tracker's hands at the time of any image. One thread.
class TrackerHints {
 public:
  /// Stores the camera in whose image they are.
  explicit TrackerHints(calib::PlacedCamera camera) : camera_(std::move(camera)) {}

  /// Adds a sample of the tracker.
  void push(const msg::HandPoses& poses);
  /// The hands at `time_ns` in undistorted camera pixels: interpolated between samples, after the
  /// newest one extrapolated by up to 40 ms. A hand that was not seen for 100 ms is left out.
  Hints at(std::int64_t time_ns) const;

 private:
  calib::PlacedCamera camera_;
  std::array<renderer::PoseHistory, msg::kMaxHands> histories_{renderer::PoseHistory(prediction()),
                                                               renderer::PoseHistory(prediction())};

  static config::Predict prediction() {
    return {.method = config::PredictMethod::velocity, .limit_ms = 40};
  }
};

/// From undistorted pixels to pixels of the image.
Points distorted(const calib::CameraModel& camera, const Points& undistorted_px);
/// From pixels of the image to undistorted pixels.
Points undistorted(const calib::CameraModel& camera, const Points& image_px);

}  // namespace handcast::landmarks
