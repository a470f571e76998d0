// SPDX-License-Identifier: Apache-2.0
#include "renderer/predict/hand_track.hpp"

#include "renderer/base/joint_math.hpp"
#include "renderer/predict/presence.hpp"

namespace handcast::renderer {

PoseHistory::Pushed HandTrack::push(std::int64_t now_ns, std::int64_t origin_ns,
                                    const msg::HandPose& pose) {
  const auto pushed = history_.push(origin_ns, pose);
  if (pushed != PoseHistory::Pushed::not_measured) heard_ns_ = now_ns;
  return pushed;
}

void HandTrack::rest(const Rest& rest, std::int64_t target_ns) {
  constexpr std::int64_t kLongest_ns = 100'000'000;
  // Farther than a tracker drifts in 20 ms.
  constexpr float kDrifts_m = 0.0015f, kMoves_m = 0.004f;
  rest_ = {};
  const std::int64_t later_ns = target_ns - rest.since_ns;
  if (rest.share <= 0 || later_ns <= 0 || later_ns > kLongest_ns) return;
  const auto then = pose_at(rest.since_ns), now = pose_at(target_ns);
  if (!then || !now) return;
  glm::vec3 moved_m{0};
  for (const int j : kPalmJoints)
    moved_m += (position(now->joints[j]) - position(then->joints[j])) /
               static_cast<float>(kPalmJoints.size());
  const float share = rest.share * (1 - glm::smoothstep(kDrifts_m, kMoves_m, glm::length(moved_m)));
  rest_ = {rest.since_ns, share};
}

std::int64_t HandTrack::held_ns(std::int64_t time_ns) const {
  const std::int64_t later_ns = time_ns - rest_.since_ns;
  if (rest_.share <= 0 || later_ns <= 0) return time_ns;
  return time_ns - static_cast<std::int64_t>(rest_.share * static_cast<float>(later_ns));
}

std::optional<Predicted> HandTrack::predict(std::int64_t now_ns, std::int64_t target_ns) const {
  const auto posed = projected_at(target_ns);
  if (!posed) return std::nullopt;
  const bool is_silent = now_ns - heard_ns_ > history_.patience_ns() || !history_.settled();
  return Predicted{*posed, is_silent};
}

std::optional<msg::HandPose> HandTrack::pose_at(std::int64_t time_ns) const {
  return history_.at(held_ns(time_ns), Presence::kLongest_ns);
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
