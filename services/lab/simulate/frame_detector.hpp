// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/landmarks/detector.hpp"

namespace handcast::simulate {

/// A frame of the twin's camera.
struct Exposure {
  std::uint64_t frame_id = 0;  ///< number of the frame
  std::int64_t origin_ns = 0;  ///< true middle of its exposure, since the epoch
  std::int64_t stamp_ns = 0;   ///< that time by the camera's clock, which the cascade sees
};

/// The result of a landmark detector on one frame.
struct Detection {
  std::optional<msg::Landmarks> landmarks;  ///< empty if the detector could not use the frame
  std::int64_t age_ns = 0;                  ///< virtual time from the frame's origin to the result
  std::int64_t work_ns = 0;                 ///< run time on this machine; 0 if no image was read
};

/// A landmark detector for frames of the twin's camera, which must be passed in ascending order.
class FrameDetector {
 public:
  virtual ~FrameDetector() = default;
  /// Receives a sample of the tracker that arrived before the next run begins.
  virtual void tell(const msg::HandPoses&) {}
  /// Runs the detector on one frame. `run` is the number of the run.
  virtual Detection detect(std::uint64_t run, const Exposure& exposure) = 0;
};

/// Makes the twin's model of a detector. `twin` must outlive it.
std::unique_ptr<FrameDetector> make_twin_detector(const twin::Twin& twin);

/// The files of networks that it reads, some of which need not exist; none if it runs no network.
std::vector<std::filesystem::path> network_files(const config::Rig& rig);

/// Opens the detector of landmarks::choose_detector(). A real detector has the age, the clock error
/// and the faults of the twin's model (Twin::spoil), but neither its noise nor its bias. `twin`: at
/// the same viewpoint; it must outlive the detector. Errors: those of landmarks::open_detector
/// (bad_config if a model is missing).
Result<std::unique_ptr<FrameDetector>> open_frame_detector(const config::Rig& rig,
                                                           const calib::Calibration& calibration,
                                                           const twin::Twin& twin,
                                                           config::Viewpoint at);

}  // namespace handcast::simulate
