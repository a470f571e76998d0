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
#include "ipc/shm/open_ring.hpp"
#include "services/landmarks/geometry/points.hpp"
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

  /// False: its landmarks come when they come, from elsewhere, also without new images.
  virtual bool reads_images() const { return true; }

  /// Whether it uses settings that change while it is open, and uses those of `rig` from now on.
  /// @{
  virtual bool is_adjustable() const { return false; }
  virtual void adjust(const config::Rig& /*rig*/) {}
  /// @}
};

/// What a detector is opened with. It refers to the rig and its calibration.
struct Opening {
  const config::Rig& rig;
  const calib::Calibration& calibration;
  std::int64_t epoch_ns = 0;   ///< time zero of the rig, CLOCK_MONOTONIC
  config::Viewpoint at{};      ///< whose images it gets
  config::Landmarks settings;  ///< its section of the rig, with the back end that was chosen
  calib::PlacedCamera camera;  ///< the lens and the place of the camera by the calibration
  ipc::OpenRing ring{};        ///< gives the rings of the rig; empty if there is none
};

/// A row of the table of detectors. Its errors name neither the service nor the back end, which
/// open_detector(), check_detector() and the service put before them. They name settings as the
/// section of the service has them: "replay.directory".
using DetectorBackend = service::Backend<Detector, Opening>;
/// Of a back end that is a file of its own: landmarks/NAME.so.
extern "C" const service::LoadedBackEnd<DetectorBackend> handcast_landmarks_back_end;

/// All detectors: the landmark models, the twin, recordings.
std::span<const DetectorBackend> detector_backends();

/// What finds the landmarks in the images of a camera.
struct DetectorChoice {
  std::string backend;  ///< `backend` or `fallback` of its section
  /// Why it is the fallback: one sentence with the file that is missing. Empty if it is not.
  std::string why;
};

/// The detector that open_detector() opens: the fallback, if there is one and a file of the back
/// end is missing.
DetectorChoice choose_detector(const config::Rig& rig,
                               config::Viewpoint at = config::Viewpoint::first);

/// Opens the detector of choose_detector(). `epoch_ns`: the start of the rig. `ring`: see Opening.
/// Errors: bad_config.
Result<std::unique_ptr<Detector>> open_detector(const config::Rig& rig,
                                                const calib::Calibration& calibration,
                                                std::int64_t epoch_ns,
                                                config::Viewpoint at = config::Viewpoint::first,
                                                const ipc::OpenRing& ring = {});
/// Checks it: see service::Backend::check. Errors: those of open_detector().
Result<void> check_detector(const config::Rig& rig, const calib::Calibration& calibration,
                            config::Viewpoint at);

}  // namespace handcast::landmarks
