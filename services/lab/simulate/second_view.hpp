// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "services/lab/simulate/frame_detector.hpp"
#include "services/lab/simulate/sensor_feed.hpp"
#include "services/pose/stereo/pairing.hpp"
#include "services/pose/stereo/stereo_tracker.hpp"

namespace handcast::simulate {

/// Runs a detector in virtual time, back to back: when it is free it takes the newest frame, or
/// waits for one that is newer than its last.
class BackToBack {
 public:
  /// `twin` must outlive the object. `on_detection` is called after each run; may be empty.
  BackToBack(const twin::Twin& twin, std::unique_ptr<FrameDetector> detector,
             OnDetection on_detection)
      : twin_(twin), detector_(std::move(detector)), on_detection_(std::move(on_detection)) {}

  /// Appends the detections that are done by `now_ns`. On entry, `events` must hold the tracker's
  /// samples that have arrived since the last call, in the order of arrival.
  void until(std::int64_t now_ns, std::vector<SensorEvent>& events);

 private:
  struct Run {
    std::int64_t done_ns;
    std::optional<msg::Landmarks> landmarks;
  };
  std::uint64_t next_frame(std::int64_t now_ns) const;
  Run begin(std::uint64_t frame, std::int64_t begin_ns);
  void tell(std::int64_t begin_ns);

  const twin::Twin& twin_;
  std::unique_ptr<FrameDetector> detector_;
  OnDetection on_detection_;
  std::vector<SensorEvent> waiting_;  ///< tracker samples that arrived after the last run began
  std::optional<Run> under_way_;
  std::uint64_t runs_ = 0;
  std::int64_t last_frame_ = -1;
  std::int64_t free_ns_ = 0;
};

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
