// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "renderer/predict/plausible_pose.hpp"
#include "services/tools/preview/scene/scene.hpp"
#include "services/tools/preview/scene/scene_maker.hpp"

namespace handcast::preview {
namespace {

using renderer::LandmarkPoints;

constexpr std::size_t kDetections = 32;
constexpr std::int64_t kOldDetection_ns = 500'000'000;
constexpr double kNearest_m = 0.05;
constexpr float kLargestSigma_px = 100;  ///< a landmark that is less certain than that is none

bool is_side(msg::Side side) { return static_cast<std::size_t>(side) < msg::kMaxHands; }

float sane_sigma(float sigma_px) {
  return sigma_px > 0 && sigma_px <= kLargestSigma_px ? sigma_px : 0;
}

}  // namespace

Hands::Hands(const config::Predict& predict, const calib::Calibration& calibration)
    : calibration_(calibration),
      tracks_{renderer::HandTrack(predict, calibration),
              renderer::HandTrack(predict, calibration)} {}

void Hands::push(const msg::HandPoses& poses) {
  for (std::size_t i = 0; i < std::min<std::size_t>(poses.count, poses.hands.size()); ++i) {
    const auto& pose = poses.hands[i];
    if (!is_side(pose.side) || !renderer::is_plausible(pose, calibration_.camera_from_tracker))
      continue;
    tracks_[static_cast<std::size_t>(pose.side)].push(sane_ns(poses.header.published_ns),
                                                      sane_ns(poses.header.origin_ns), pose);
  }
}

void Hands::push(const msg::Landmarks& landmarks) {
  detections_.push_back(landmarks);
  auto& origin_ns = detections_.back().header.origin_ns;
  origin_ns = sane_ns(origin_ns);
  if (detections_.size() > kDetections) detections_.pop_front();
}

std::optional<msg::HandPose> Hands::pose_at(msg::Side side, std::int64_t time_ns) const {
  return track_of(side).recent_pose(time_ns);
}

const msg::Landmarks* Hands::detection_near(msg::Side side, std::int64_t time_ns) const {
  const msg::Landmarks* nearest = nullptr;
  const auto distance = [time_ns](const msg::Landmarks& landmarks) {
    return std::abs(static_cast<double>(landmarks.header.origin_ns) - static_cast<double>(time_ns));
  };
  for (const auto& landmarks : detections_)
    if (landmarks.find(side) && distance(landmarks) < kOldDetection_ns &&
        (!nearest || distance(landmarks) <= distance(*nearest)))
      nearest = &landmarks;
  return nearest;
}

std::optional<LandmarkPoints> Hands::offset_at(msg::Side side, std::int64_t time_ns) const {
  const auto* detection = detection_near(side, time_ns);
  if (!detection) return std::nullopt;
  const auto tracker = track_of(side).recent_landmarks(detection->header.origin_ns);
  if (!tracker) return std::nullopt;
  const auto* hand = detection->find(side);
  LandmarkPoints offset{};
  glm::vec2 sum(0);
  float seen = 0;
  for (std::size_t i = 0; i < offset.size(); ++i) {
    if (!renderer::was_seen(hand->points[i])) continue;
    offset[i] = renderer::position_px(hand->points[i]) - (*tracker)[i];
    sum += offset[i];
    ++seen;
  }
  if (seen == 0) return std::nullopt;
  for (std::size_t i = 0; i < offset.size(); ++i)
    if (!renderer::was_seen(hand->points[i])) offset[i] = sum / seen;
  return offset;
}

std::optional<renderer::Similarity> Hands::motion(msg::Side side, std::int64_t from_ns,
                                                  std::int64_t to_ns) const {
  auto from = track_of(side).recent_landmarks(from_ns), to = track_of(side).recent_landmarks(to_ns);
  if (!from || !to) return std::nullopt;
  for (auto* points : {&*from, &*to})
    for (auto& point : *points) point = calibration_.camera.distort(point);
  return renderer::fit_similarity(*from, *to);
}

/// Shows no joint if one is behind the camera.
void Hands::show_joints(const msg::HandPose& pose, ShownHand& hand) const {
  std::vector<glm::vec2> joints_px;
  std::vector<float> depths_m;
  for (const auto& joint : pose.joints) {
    const auto& [x, y, z] = joint.position_m;
    const glm::dvec3 in_camera(calibration_.camera_from_tracker * glm::dvec4(x, y, z, 1));
    if (!(in_camera.z > kNearest_m)) return;
    joints_px.push_back(calibration_.camera.distort(calibration_.camera.project(in_camera)));
    depths_m.push_back(static_cast<float>(in_camera.z));
  }
  hand.joints_px = std::move(joints_px);
  hand.depths_m = std::move(depths_m);
}

void Hands::show_landmarks(std::int64_t time_ns, ShownHand& hand) const {
  const auto* detection = detection_near(hand.side, time_ns);
  if (!detection) return;
  const auto then = track_of(hand.side).recent_landmarks(detection->header.origin_ns);
  const auto now = track_of(hand.side).recent_landmarks(time_ns);
  const auto* found = detection->find(hand.side);
  for (std::size_t i = 0; i < hand.landmarks.size(); ++i) {
    const auto& point = found->points[i];
    if (!renderer::was_seen(point)) continue;
    const auto moved = then && now ? (*now)[i] - (*then)[i] : glm::vec2(0);
    hand.landmarks[i] = {calibration_.camera.distort(renderer::position_px(point) + moved),
                         sane_sigma(point.sigma_px)};
  }
}

std::optional<ShownHand> Hands::at(msg::Side side, std::int64_t time_ns) const {
  ShownHand hand{.side = side, .joints_px = {}};
  if (const auto pose = pose_at(side, time_ns)) show_joints(*pose, hand);
  show_landmarks(time_ns, hand);
  const bool has_landmarks =
      std::ranges::any_of(hand.landmarks, [](const auto& mark) { return mark.has_value(); });
  if (hand.joints_px.empty() && !has_landmarks) return std::nullopt;
  return hand;
}

}  // namespace handcast::preview
