// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/predict/pose_history.hpp"
#include "services/landmarks/finder/hand_finder.hpp"

namespace handcast::landmarks {

/// What the tracker says of the hands at an image's time: undistorted camera px.
class TrackerHints {
 public:
  explicit TrackerHints(const calib::Calibration& calibration) : calibration_(calibration) {}

  void push(const msg::HandPoses& poses);
  /// Between samples interpolated, after the newest one as it moved, up to 40 ms; nothing of a hand
  /// not seen for 100 ms.
  Hints at(std::int64_t time_ns) const;

 private:
  calib::Calibration calibration_;
  std::array<renderer::PoseHistory, msg::kMaxHands> histories_{renderer::PoseHistory(prediction()),
                                                               renderer::PoseHistory(prediction())};

  static config::Predict prediction() {
    return {.method = config::PredictMethod::velocity, .limit_ms = 40};
  }
};

/// The 21 landmarks' joints of a pose; nothing where one is behind the camera.
std::optional<Points> project(const calib::Calibration& calibration, const msg::HandPose& pose);

/// From undistorted px to where the lens puts them, and back.
Points distorted(const calib::CameraModel& camera, const Points& undistorted_px);
Points undistorted(const calib::CameraModel& camera, const Points& image_px);

}  // namespace handcast::landmarks
