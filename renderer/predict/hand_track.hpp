// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/predict/pose_history.hpp"

namespace handcast::renderer {

/// One hand at the time of the photons, as the tracker alone has it.
struct Predicted {
  msg::HandPose pose;          ///< tracker space
  LandmarkPoints landmarks{};  ///< P: the pose's landmarks in the camera
  bool is_silent = false;      ///< the tracker has said nothing credible for a while
};

/// Step "predict" of the cascade and its state: the recent tracker samples of one hand, asked for
/// at a time. One thread.
class HandTrack {
 public:
  HandTrack(const config::Predict& settings, const calib::Calibration& calibration)
      : calibration_(calibration), history_(settings) {}

  /// A tracker sample of this hand, taken at `origin_ns`, arrived at `now_ns`.
  PoseHistory::Pushed push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose);

  /// The hand at `target_ns`. Empty if the hand is not in sight.
  std::optional<Predicted> predict(std::int64_t now_ns, std::int64_t target_ns) const;

  /// The pose at any time, as far as it is known by now: interpolated, predicted, or held.
  std::optional<msg::HandPose> pose_at(std::int64_t time_ns) const;
  /// P of pose_at().
  std::optional<LandmarkPoints> landmarks_at(std::int64_t time_ns) const;
  /// The same as pose_at(), but empty if the tracker has been silent for 0.2 s.
  std::optional<msg::HandPose> recent_pose(std::int64_t time_ns) const {
    return history_.at(time_ns);
  }
  /// P of recent_pose().
  std::optional<LandmarkPoints> recent_landmarks(std::int64_t time_ns) const;

  /// The tracker jumped at this time: poses before it are guesses.
  std::int64_t begins_ns() const { return history_.begins_ns(); }
  /// Time of the newest sample; later poses are predicted.
  std::int64_t newest_ns() const { return history_.newest_ns(); }

 private:
  std::optional<LandmarkPoints> projected(const std::optional<msg::HandPose>& pose) const;

  calib::Calibration calibration_;
  PoseHistory history_;
  std::int64_t heard_ns_ = 0;  ///< when the newest tracker sample arrived
};

}  // namespace handcast::renderer
