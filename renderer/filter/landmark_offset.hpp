// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::renderer {

/// Learns the landmark offsets of a detector: where it sees each joint in comparison with the
/// tracker's joint of the same name. The two do not mean the same points: one may lie nearer to the
/// web, the other in the middle of the knuckle, and this difference turns with the bone, unlike
/// errors of the calibration or of the place of the hand. One displacement per landmark is learned
/// in the frame of its joint: an information filter over some seconds, with the prior that there is
/// none. See `docs/method.md#filter`. One thread.
class LandmarkOffset {
 public:
  /// Copies the calibration.
  explicit LandmarkOffset(const calib::Calibration& calibration) : calibration_(calibration) {}

  /// Adds the landmarks of an image (undistorted px) and the tracker's hand at the same time.
  void learn(std::int64_t origin_ns, const msg::HandPose& pose, const msg::HandLandmarks& seen);

  /// `seen`, moved to the joints as the tracker defines them, by what the last learn() knew of the
  /// hand. While the tracker is silent, this keeps the landmarks where they were.
  msg::HandLandmarks as_tracked(const msg::HandLandmarks& seen) const;

  /// How far the landmark lies from the tracker's joint, m, in the frame of the joint.
  const glm::dvec3& displacement_m(int landmark) const {
    return learned_[static_cast<std::size_t>(landmark)].displacement_m;
  }

 private:
  struct Learned {
    glm::dmat3 information{0};  ///< 1/m^2
    glm::dvec3 weighted{0};     ///< information times displacement
    glm::dvec3 displacement_m{0};
    glm::dvec2 displacement_px{0};  ///< in the last image
  };

  /// Adds what is left of an offset without the displacement that is known; nothing if the weight
  /// (1/px^2) is 0.
  static void add(const glm::dmat3x2& jacobian_px_per_m, glm::dvec2 left_px, double weight,
                  Learned& learned);

  calib::Calibration calibration_;
  std::array<Learned, msg::kLandmarks> learned_;
  std::int64_t last_ns_ = 0;
};

}  // namespace handcast::renderer
