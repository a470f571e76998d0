// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "calib/calibration.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Holds the fingers of one hand that have snapped. A tracker that loses sight of a finger guesses
/// it, so that its joints step although the finger rests, and step back tenths of a second later.
/// Landmarks put the finger back in the image, but its flexion stays wrong, and with it the skin
/// that is drawn on it. One thread.
class FingerSnaps {
 public:
  /// Copies the calibration.
  explicit FingerSnaps(const calib::Calibration& calibration) : calibration_(calibration) {}

  /// Adds a detection. Ignored if it is older than the newest.
  void detection(std::int64_t origin_ns, const msg::HandLandmarks& seen);

  /// The sample `pose` (tracker space) with each finger that has snapped where it was before, as
  /// seen from the palm. A step that the finger's own motion does not explain counts as a snap, for
  /// half a second at most, while the landmarks of a later image fit the finger as it was before
  /// the step and not as it is after it. A sample that is not newer than the last is returned
  /// unchanged. `moved_px`: Q̂ - P of the last frame.
  msg::HandPose held(std::int64_t origin_ns, const msg::HandPose& pose,
                     const LandmarkPoints& moved_px);
  /// Drops all samples and landmarks: those of a tracker that was silent cannot be compared.
  void forget() { *this = FingerSnaps(calibration_); }

 private:
  static constexpr int kFingerJoints = 4;

  /// The joints of a finger that it can move, as seen from the palm.
  using Finger = std::array<msg::Joint, kFingerJoints>;
  /// A finger that has snapped.
  struct Snap {
    std::int64_t since_ns = 0;  ///< time of the first sample that is wrong
    Finger before{};
    LandmarkPoints moved_px{};  ///< Q̂ - P before
  };
  struct Detection {
    std::int64_t origin_ns = 0;
    msg::HandLandmarks seen;
  };

  static Finger from_palm(const msg::HandPose& pose, int finger);
  static msg::HandPose with_finger(msg::HandPose pose, int finger, const Finger& joints);
  bool contradicts(const msg::HandPose& pose, int finger, const Snap& snap, float nearer) const;
  std::optional<float> distance_px(const msg::HandPose& pose, int finger,
                                   const LandmarkPoints& moved_px) const;

  calib::Calibration calibration_;
  std::optional<Detection> newest_;
  std::optional<std::int64_t> last_ns_;        ///< time of the last sample
  std::array<Finger, kFingers> last_{};        ///< its fingers
  std::array<glm::vec3, kFingers> tip_m_s_{};  ///< velocities of their tips
  std::array<std::optional<Snap>, kFingers> snaps_{};
};

}  // namespace handcast::renderer
