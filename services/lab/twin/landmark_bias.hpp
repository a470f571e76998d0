// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "config/sections/twin/detector.hpp"
#include "ipc/msg/landmarks.hpp"
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

}  // namespace handcast::twin
