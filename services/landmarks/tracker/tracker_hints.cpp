// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/tracker/tracker_hints.hpp"

#include "renderer/predict/plausible_pose.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::landmarks {
namespace {

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
      hints[side] = renderer::project_landmarks(camera_.model, camera_.from_tracker, *pose);
  return hints;
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
