// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/similarity.hpp"
#include "renderer/predict/hand_track.hpp"
#include "services/tools/preview/scene/scene.hpp"

namespace handcast::preview {

/// The motion of the hands by the tracker, and the newest landmarks. One thread.
class Hands {
 public:
  /// Without messages. Copies both arguments.
  Hands(const config::Predict& predict, const calib::Calibration& calibration);

  /// Adds a message. Poses and landmarks that cannot be those of a hand are left out.
  /// @{
  void push(const msg::HandPoses& poses);
  void push(const msg::Landmarks& landmarks);
  /// @}

  /// The pose of a hand at a time, tracker space. Empty without a sample in the 0.2 s before it.
  std::optional<msg::HandPose> pose_at(msg::Side side, std::int64_t time_ns) const;
  /// How far the landmarks of a hand are from those of the tracker, undistorted camera px. Empty
  /// if either is unknown.
  std::optional<renderer::LandmarkPoints> offset_at(msg::Side side, std::int64_t time_ns) const;
  /// The motion of a hand in the image between two times. Empty if it is unknown.
  std::optional<renderer::Similarity> motion(msg::Side side, std::int64_t from_ns,
                                             std::int64_t to_ns) const;
  /// Joints and landmarks of a hand at a time. Empty if it has neither.
  std::optional<ShownHand> at(msg::Side side, std::int64_t time_ns) const;

 private:
  const renderer::HandTrack& track_of(msg::Side side) const {
    return tracks_[static_cast<std::size_t>(side)];
  }
  const msg::Landmarks* detection_near(msg::Side side, std::int64_t time_ns) const;
  std::vector<glm::vec2> joints_of(const msg::HandPose& pose) const;
  void show_landmarks(std::int64_t time_ns, ShownHand& hand) const;

  calib::Calibration calibration_;
  std::array<renderer::HandTrack, msg::kMaxHands> tracks_;  ///< by side
  std::deque<msg::Landmarks> detections_;                   ///< oldest first
};

}  // namespace handcast::preview
