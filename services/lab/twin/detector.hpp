// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/twin.hpp"
#include "config/sections/twin/detector.hpp"
#include "ipc/msg/landmarks.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {

/// What a network takes a hand's appearance for: the posture of the fingers and the side from which
/// the camera sees the hand. Radians, or lengths of unit vectors.
inline constexpr int kPoseNumbers = 2 * kFingers + 9;
using PoseNumbers = std::array<double, kPoseNumbers>;
/// The numbers of a hand in camera space.
PoseNumbers pose_numbers(const JointFrames& camera_frames);

/// Speed of the pose numbers in natural motion, per second: the mean over the four recordings of
/// the median over time. At this speed the error lasts for bias_ms.
inline constexpr double kUsualPoseSpeed = 2.8;

/// The error of a landmark detector that lasts: a smooth random function of the pose, drawn from
/// the seed. So a still hand has a constant error, and a moving one an error whose correlation time
/// depends on how fast the pose changes. It is a Gaussian process by random Fourier features
/// (Rahimi and Recht 2007), with a rational-quadratic kernel: parts of it change faster than
/// others.
class LandmarkBias {
 public:
  /// Copies its arguments. `radius_m`: of the flesh at the joints of the true hand.
  LandmarkBias(const config::TwinDetector& settings, int seed,
               const std::array<float, kJoints>& radius_m);

  /// The error of each landmark in px. `truth`: the true landmarks, px.
  std::array<glm::dvec2, msg::kLandmarks> at(
      renderer::Side side, const JointFrames& camera_frames,
      const std::array<glm::vec2, msg::kLandmarks>& truth) const;

 private:
  static constexpr std::size_t kWaves = 96;
  struct Wave {
    PoseNumbers frequency{};
    double phase = 0;
  };

  std::array<double, kWaves> waves_at(const JointFrames& camera_frames) const;

  config::TwinDetector settings_;
  std::array<float, kJoints> radius_m_;
  std::vector<Wave> waves_;
  /// By landmark, along and across its finger.
  std::array<std::array<std::array<double, kWaves>, 2>, msg::kLandmarks> weights_{};
};

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
