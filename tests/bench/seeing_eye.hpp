// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/owned.hpp"
#include "services/lab/twin/camera_scene.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/landmarks/detector.hpp"
#include "services/landmarks/tracker/tracker_hints.hpp"

namespace handcast::bench {

/// How far a landmark is from the joint that it belongs to.
struct Miss {
  double px = 0;   ///< in square pixels of the image
  double deg = 0;  ///< about the camera
  double mm = 0;   ///< across the line of sight, at the joint
};

/// A camera before the twin's hands, with its landmark detector.
class SeeingEye {
 public:
  /// `at`: which camera of the calibration it is, as the detector has it. `rows_per_row`: rows of
  /// its images for each row of the sensor; the driver of the Leap controller makes the one of the
  /// other. Opens rig.landmarks; `twin` outlives it. Errors: those of open_detector().
  static Result<std::unique_ptr<SeeingEye>> open(const calib::Calibration& calibration,
                                                 config::Viewpoint at, int rows_per_row,
                                                 const config::Rig& rig, const twin::Twin& twin);

  /// What the poses predict, for the detector.
  void tell(const msg::HandPoses& poses) { hints_.push(poses); }
  /// The detector begins anew. Errors: those of open_detector().
  Result<void> forget();
  /// Draws image `k` at `time_ns` and finds landmarks in it. `hints`: with those of tell().
  Result<msg::Landmarks> look(std::uint64_t k, std::int64_t time_ns, bool hints);
  /// The landmarks of hands that are there.
  std::vector<Miss> compare(const msg::Landmarks& seen) const;

 private:
  SeeingEye(const calib::Calibration& calibration, config::Viewpoint at, calib::PlacedCamera camera,
            int rows_per_row, const config::Rig& rig, const twin::Twin& twin,
            std::unique_ptr<landmarks::Detector> detector);
  void write_frame();

  const twin::Twin& twin_;
  calib::Calibration calibration_;
  config::Viewpoint at_;
  calib::PlacedCamera camera_;
  config::Rig rig_;
  twin::CameraScene scene_;
  std::int64_t exposure_ns_;
  std::unique_ptr<landmarks::Detector> detector_;
  landmarks::TrackerHints hints_;
  renderer::Image<std::uint8_t> sensor_;
  std::vector<std::uint8_t> both_;  ///< as the Leap controller sends it
  msg::Owned<msg::CameraFrame> frame_;
};

}  // namespace handcast::bench
