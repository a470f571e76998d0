// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/tracker/tracker_hints.hpp"

#include "renderer/predict/plausible_pose.hpp"

namespace handcast::landmarks {
namespace {

constexpr double kNearest_m = 0.05;
constexpr std::int64_t kLost_ns = 100'000'000;

}  // namespace

void TrackerHints::push(const msg::HandPoses& poses) {
  for (std::uint32_t i = 0; i < poses.count && i < poses.hands.size(); ++i) {
    const msg::HandPose& pose = poses.hands[i];
    if (!renderer::is_plausible(pose, camera_.from_tracker)) continue;
    histories_[pose.side == msg::Side::left ? 0 : 1].push(poses.header.origin_ns, pose);
  }
}

Hints TrackerHints::at(std::int64_t time_ns) const {
  Hints hints;
  for (std::size_t side = 0; side < histories_.size(); ++side)
    if (const auto pose = histories_[side].at(time_ns, kLost_ns))
      hints[side] = project(camera_, *pose);
  return hints;
}

std::optional<Points> project(const calib::PlacedCamera& camera, const msg::HandPose& pose) {
  Points points;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& [x, y, z] = pose.joints[msg::kJointOfLandmark[i]].position_m;
    const glm::dvec3 in_camera(camera.from_tracker * glm::dvec4(x, y, z, 1));
    if (!(in_camera.z > kNearest_m)) return std::nullopt;
    points[i] = camera.model.project(in_camera);
  }
  return points;
}

Points distorted(const calib::CameraModel& camera, const Points& undistorted_px) {
  Points image_px;
  for (std::size_t i = 0; i < image_px.size(); ++i) image_px[i] = camera.distort(undistorted_px[i]);
  return image_px;
}

Points undistorted(const calib::CameraModel& camera, const Points& image_px) {
  Points undistorted_px;
  for (std::size_t i = 0; i < undistorted_px.size(); ++i)
    undistorted_px[i] = camera.undistort(image_px[i]);
  return undistorted_px;
}

}  // namespace handcast::landmarks
