// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"
#include "services/runtime/backends.hpp"

namespace handcast::landmarks {

/// Finds the 21 landmarks of each hand in a camera image. One thread.
class Detector {
 public:
  virtual ~Detector() = default;

  /// The landmarks of `frame`, with its id and origin; count is 0 if there is no hand. `hints`: the
  /// tracker's hands at the time of the frame, in undistorted camera pixels.
  ///
  /// If a detection is not finished by the deadline, detect() returns a timeout and the detection
  /// continues: the next call ignores its frame, waits for the detection and returns the landmarks
  /// of the earlier frame. (A network is not interrupted: it returns a few ms after the deadline.)
  /// Errors: timeout; bad_data (this image cannot be used).
  virtual Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints& hints,
                                        Deadline deadline) = 0;
};

/// A row of the table of detectors, opened with the rig, its calibration and its epoch (ns).
using DetectorBackend = service::Backend<Detector, config::Rig, calib::Calibration, std::int64_t>;

/// All detectors: the landmark models, the twin, recordings.
std::span<const DetectorBackend> detector_backends();

/// What finds the landmarks of a rig.
struct DetectorChoice {
  std::string backend;  ///< rig.landmarks.backend, or rig.landmarks.fallback
  /// Why it is the fallback: one sentence with the file that is missing. Empty if it is not.
  std::string why;
};

/// The detector that open_detector() opens: the fallback, if there is one and a file of the back
/// end is missing.
DetectorChoice choose_detector(const config::Rig& rig);

/// Errors: bad_config (landmarks.fallback names no back end).
Result<void> check_fallback(const config::Rig& rig);

/// Opens the detector of choose_detector(). `epoch_ns`: the start of the rig. Errors: bad_config.
Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns);

}  // namespace handcast::landmarks
