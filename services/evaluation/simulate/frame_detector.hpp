// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/evaluation/simulate/exposure.hpp"
#include "services/evaluation/twin/twin.hpp"

namespace handcast::simulate {

/// What a landmark detector made of one frame.
struct Detection {
  std::optional<msg::Landmarks> landmarks;  ///< nothing where it could not use the frame
  std::int64_t age_ns = 0;                  ///< virtual: done this long after the frame's origin
  std::int64_t work_ns = 0;  ///< what it took on this machine; 0: nothing was looked at
};

/// A landmark detector that is shown frames of the twin's camera, in ascending order.
class FrameDetector {
 public:
  virtual ~FrameDetector() = default;
  /// A sample of the tracker that arrived before the next frame is begun.
  virtual void tell(const msg::HandPoses&) {}
  virtual Detection detect(std::uint64_t run, const Exposure& exposure) = 0;
};

/// The twin's model of a detector.
std::unique_ptr<FrameDetector> make_twin_detector(const twin::Twin& twin);

/// What runs in the simulator for rig.landmarks.backend: that detector itself on the twin's images;
/// the twin's model for "twin", and for "replay", whose landmarks belong to other images.
std::string simulated_backend(const config::Rig& rig);

/// Opens it. A detector takes the twin's model's age (twin.detector.age_ms, age_sd_ms) and clock,
/// none of its other errors. Errors: as the detector's daemon says them (a missing model:
/// bad_config).
Result<std::unique_ptr<FrameDetector>> open_frame_detector(const config::Rig& rig,
                                                           const calib::Calibration& calibration,
                                                           const twin::Twin& twin);

}  // namespace handcast::simulate
