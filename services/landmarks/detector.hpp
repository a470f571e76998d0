// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/landmarks/finder/hand_finder.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::landmarks {

/// Finds the 21 landmarks of each hand in a camera image. One thread.
class Detector {
 public:
  virtual ~Detector() = default;

  /// The landmarks of `frame`, with its id and origin; an image without a hand gives count 0.
  /// `hints`: what the tracker says of the hands at that time, undistorted camera px. A detection
  /// that is not done by the deadline is a timeout and goes on: the next call waits for it,
  /// whatever frame it is given, and returns the landmarks of the frame it was begun with. (A
  /// network at work is not cut short: it is done a few ms after the deadline.) Errors: timeout,
  /// bad_data (this image cannot be used).
  virtual Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints& hints,
                                        Deadline deadline) = 0;
};

/// Opened with the rig, its calibration and its epoch (ns).
using DetectorBackend = service::Backend<Detector, config::Rig, calib::Calibration, std::int64_t>;

std::span<const DetectorBackend> detector_backends();

/// Opens the back end that rig.landmarks.backend names.
Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns);

}  // namespace handcast::landmarks
