// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/hand_track.hpp"

#include "renderer/predict/presence.hpp"

namespace handcast::renderer {

PoseHistory::Pushed HandTrack::push(std::int64_t now_ns, std::int64_t origin_ns,
                                    const msg::HandPose& pose) {
  const auto pushed = history_.push(origin_ns, pose);
  if (pushed != PoseHistory::Pushed::not_measured) heard_ns_ = now_ns;
  return pushed;
}

std::optional<Predicted> HandTrack::predict(std::int64_t now_ns, std::int64_t target_ns) const {
  const auto posed = projected_at(target_ns);
  if (!posed) return std::nullopt;
  const bool is_silent = now_ns - heard_ns_ > history_.patience_ns() || !history_.settled();
  return Predicted{*posed, is_silent};
}

std::optional<msg::HandPose> HandTrack::pose_at(std::int64_t time_ns) const {
  return history_.at(time_ns, Presence::kLongest_ns);
}

std::optional<ProjectedPose> HandTrack::projected_at(std::int64_t time_ns) const {
  const auto pose = pose_at(time_ns);
  return pose ? project(calibration_, *pose) : std::nullopt;
}

std::optional<LandmarkPoints> HandTrack::landmarks_at(std::int64_t time_ns) const {
  return projected(pose_at(time_ns));
}

std::optional<LandmarkPoints> HandTrack::recent_landmarks(std::int64_t time_ns) const {
  return projected(recent_pose(time_ns));
}

std::optional<LandmarkPoints> HandTrack::projected(const std::optional<msg::HandPose>& pose) const {
  return pose ? project_landmarks(calibration_, *pose) : std::nullopt;
}

}  // namespace handcast::renderer
