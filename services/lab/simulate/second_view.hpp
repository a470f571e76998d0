// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "services/lab/simulate/back_to_back.hpp"
#include "services/pose/stereo/pairing.hpp"
#include "services/pose/stereo/stereo_tracker.hpp"

namespace handcast::simulate {

/// The second camera of a rig with pose.backend "stereo", its detector, and the tracker that makes
/// poses from the landmarks of both.
class SecondView {
 public:
  /// Errors: bad_config (the calibration has no second camera), those of Twin::create(),
  /// open_frame_detector() and StereoTracker::open().
  static Result<std::unique_ptr<SecondView>> open(const config::Rig& rig,
                                                  const calib::Calibration& calibration);

  /// Takes the landmarks of the first view among `events`, and runs the second detector until
  /// `now_ns`. Returns the poses that were made, with the times at which they arrive. `poses`:
  /// those that have arrived since the last call, hints for the detector.
  std::vector<SensorEvent> until(std::int64_t now_ns, const std::vector<SensorEvent>& events,
                                 const std::vector<SensorEvent>& poses);

 private:
  SecondView(std::unique_ptr<twin::Twin> twin, std::unique_ptr<FrameDetector> detector,
             const pose::stereo::StereoTracker& tracker, const config::PoseStereo& settings)
      : twin_(std::move(twin)),
        detector_(*twin_, std::move(detector), {}),
        tracker_(tracker),
        pairing_(settings) {}
  void sample(std::int64_t now_ns, std::vector<SensorEvent>& made);

  std::unique_ptr<twin::Twin> twin_;
  BackToBack detector_;
  pose::stereo::StereoTracker tracker_;
  pose::stereo::Pairing pairing_;
};

}  // namespace handcast::simulate
