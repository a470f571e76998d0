// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/lab/twin/landmark_bias.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

/// The twin's model of a landmark detector: the true landmarks with an error that depends on the
/// pose (LandmarkBias), white noise and outliers, late and sometimes missing. The joint convention
/// of a real detector is assumed to be corrected. Pure functions of the settings, the seed and the
/// arguments.
class DetectorModel {
 public:
  /// Copies its arguments. `seed` selects the random errors; `person` is the shape of the true
  /// hands.
  DetectorModel(const config::TwinDetector& settings, int seed, const calib::CameraModel& camera,
                const renderer::HandShape& person);

  /// Time from the middle of the exposure to the result of run number `run`.
  std::int64_t age_ns(std::uint64_t run) const;
  /// True if run number `run`, on the frame of `origin_ns`, finds no hand.
  bool lost(std::uint64_t run, std::int64_t origin_ns) const;
  /// The stamp of a detection on a frame with this stamp.
  std::int64_t stamp_ns(std::int64_t frame_stamp_ns) const;
  /// The landmarks that run number `run` reports if `truth` are the true ones at `origin_ns`
  /// (undistorted camera px), of a hand whose true joints are `camera_frames` (camera space).
  /// Points outside the image have confidence 0.
  msg::HandLandmarks report(std::uint64_t run, msg::Side side,
                            const std::array<glm::vec2, msg::kLandmarks>& truth,
                            const renderer::JointFrames& camera_frames,
                            std::int64_t origin_ns) const;
  /// Adds the outliers and the faults of run number `run`, on a frame of `origin_ns`, to a hand.
  /// The landmarks of report() have them already.
  void spoil(std::uint64_t run, std::int64_t origin_ns, msg::HandLandmarks& hand) const;

 private:
  /// Outliers at a range of distances.
  struct Outliers {
    double share;  ///< of the landmarks
    double nearest_px, farthest_px;
    Stream stream;
  };
  glm::dvec2 outlier_px(const Outliers& outliers, std::uint64_t run, std::uint64_t draw) const;

  config::TwinDetector settings_;
  int seed_;
  calib::CameraModel camera_;
  LandmarkBias bias_;
};

}  // namespace handcast::twin
