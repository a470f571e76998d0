// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/predict/pose_history.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {

/// One hand at the time of the photons (T), from the tracker alone.
struct Predicted {
  ProjectedPose posed;
  bool is_silent = false;  ///< no sample for a while, or a jump too recent for a velocity
};

/// Step "predict" and its state: the recent tracker samples of one hand, from which a pose is
/// computed for any time. See `docs/method.md#predict`. One thread.
class HandTrack {
 public:
  /// Without samples. Copies both arguments.
  HandTrack(const config::Predict& settings, const calib::Calibration& calibration)
      : calibration_(calibration), history_(settings) {}
  /// Predicts with other settings from now on.
  void adjust(const config::Predict& settings) { history_.adjust(settings); }

  /// Adds a tracker sample of this hand that was taken at `origin_ns` and arrived at `now_ns`.
  PoseHistory::Pushed push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose);

  /// What an image shows of a hand's motion.
  struct Rest {
    std::int64_t since_ns = 0;  ///< exposure of the image
    float share = 0;            ///< 1: the hand rests, 0: it moves
  };
  /// A hand that rests stays where it was seen, although the drift and the noise of its tracker
  /// predict a motion until `target_ns`. From now on, pose_at() of a later time is that of
  /// held_ns(), unless the tracker moves the palm by more than a drift.
  void rest(const Rest& rest, std::int64_t target_ns);
  /// The time whose pose is that at `time_ns`.
  std::int64_t held_ns(std::int64_t time_ns) const;

  /// The hand at `target_ns`. Empty if projected_at() is.
  std::optional<Predicted> predict(std::int64_t now_ns, std::int64_t target_ns) const;

  /// The pose at `time_ns` from the samples so far: interpolated, predicted, or held. Empty if
  /// there is no sample or the newest one is more than 0.9 s older than `time_ns`.
  std::optional<msg::HandPose> pose_at(std::int64_t time_ns) const;
  /// pose_at(), projected. Empty if there is no pose, or no P for it (see project()).
  std::optional<ProjectedPose> projected_at(std::int64_t time_ns) const;
  /// P of projected_at(); empty if there is none.
  std::optional<LandmarkPoints> landmarks_at(std::int64_t time_ns) const;
  /// The same as pose_at() of a hand that moves, but empty if the newest sample is more than 0.2 s
  /// older.
  std::optional<msg::HandPose> recent_pose(std::int64_t time_ns) const {
    return history_.at(time_ns);
  }
  /// P of recent_pose(); empty if there is none.
  std::optional<LandmarkPoints> recent_landmarks(std::int64_t time_ns) const;

  /// When the tracker last jumped. Poses at earlier times are guesses.
  std::int64_t begins_ns() const { return history_.begins_ns(); }
  /// The same, or since when the hand is held at rest. A pose before that and one after it do not
  /// show how the hand moved.
  std::int64_t comparable_ns() const {
    return rest_.share > 0 ? std::max(rest_.since_ns, begins_ns()) : begins_ns();
  }
  /// Time of the newest sample, 0 if there is none. Later poses are predicted.
  std::int64_t newest_ns() const { return history_.newest_ns(); }

 private:
  std::optional<LandmarkPoints> projected(const std::optional<msg::HandPose>& pose) const;

  calib::Calibration calibration_;
  PoseHistory history_;
  Rest rest_;
  std::int64_t heard_ns_ = 0;  ///< when the newest tracker sample arrived
};

}  // namespace handcast::renderer
