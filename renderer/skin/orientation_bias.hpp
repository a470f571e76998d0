// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"

namespace handcast::renderer {

/// Learns the orientation bias of a tracker: by how much its hands are turned about their wrist,
/// from the landmarks that the camera sees. In one image, outer joints of the fingers that are
/// nearer to the camera than others tell a turn from a shift: the landmarks' offsets grow with the
/// joints' depth. The tracker's other errors look the same in one pose and not in the next, so a
/// turn is believed as it is seen in many poses: an information filter over some seconds, with the
/// prior that there is none. See `docs/method.md#skin`. One thread.
class OrientationBias {
 public:
  /// Copies the calibration.
  explicit OrientationBias(const calib::Calibration& calibration) : calibration_(calibration) {}

  /// Adds the landmarks of an image (undistorted px) and the tracker's hand at the same time.
  void learn(std::int64_t origin_ns, const msg::HandPose& pose, const msg::HandLandmarks& seen);

  /// The pose turned about its wrist by what was learned.
  msg::HandPose turned(const msg::HandPose& pose) const;

  /// The turn about the camera's axes, rad.
  const glm::dvec3& angle_rad() const { return angle_rad_; }

 private:
  calib::Calibration calibration_;
  glm::dmat3 information_{0};
  glm::dvec3 weighted_{0};  ///< information times turn
  glm::dvec3 angle_rad_{0};
  std::int64_t last_ns_ = 0;
};

}  // namespace handcast::renderer
