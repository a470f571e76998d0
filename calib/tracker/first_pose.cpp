// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/first_pose.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <vector>

namespace handcast::calib {
namespace {

constexpr std::size_t kMostPoints = 600;
constexpr int kSamples = 200;
constexpr double kConfidence = 0.999;
constexpr std::size_t kLeastAgreeing = 12;

struct Candidate {
  PoseAndOffset pose;
  std::size_t agreeing = 0;
};

double tolerance_px(std::span<const Sighting> seen) {
  std::vector<double> sigmas;
  for (const auto& one : seen) sigmas.push_back(one.sigma_px);
  std::ranges::sort(sigmas);
  return std::max(6.0, 4 * sigmas[sigmas.size() / 2]);
}

/// The pose for one offset.
Candidate candidate_for(std::span<const Sighting> seen, const TrackerPath& path,
                        const CameraModel& camera, double offset_s, double tolerance) {
  std::vector<cv::Point3d> places;
  std::vector<cv::Point2d> pixels;
  const std::size_t every = std::max<std::size_t>(1, seen.size() / kMostPoints);
  for (std::size_t i = 0; i < seen.size(); i += every)
    if (const auto at = path.at(seen[i].time_ns + static_cast<std::int64_t>(offset_s * 1e9),
                                seen[i].point)) {
      places.emplace_back(at->place_m.x, at->place_m.y, at->place_m.z);
      pixels.emplace_back(seen[i].undistorted_px.x, seen[i].undistorted_px.y);
    }
  if (places.size() < kLeastAgreeing) return {};
  const cv::Matx33d matrix(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  cv::Vec3d turn, shift;
  std::vector<int> inliers;
  try {
    cv::setRNGSeed(1);
    if (!cv::solvePnPRansac(places, pixels, matrix, cv::noArray(), turn, shift, false, kSamples,
                            static_cast<float>(tolerance), kConfidence, inliers, cv::SOLVEPNP_SQPNP))
      return {};
  } catch (const cv::Exception&) {  // degenerate points
    return {};
  }
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Candidate found{{{}, offset_s}, inliers.size()};
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      found.pose.camera_from_tracker[column][row] = rotation(row, column);
  found.pose.camera_from_tracker[3] = {shift[0], shift[1], shift[2], 1};
  return found;
}

}  // namespace

std::optional<PoseAndOffset> first_pose(std::span<const Sighting> seen, const TrackerPath& path,
                                        const CameraModel& camera) {
  constexpr double kStep_s = 0.02;
  if (seen.empty()) return std::nullopt;
  const double tolerance = tolerance_px(seen);
  Candidate best;
  for (int step = 0; step <= 2 * std::lround(kLongestOffset_s / kStep_s); ++step) {
    // 0, 1, -1, 2, -2 ... steps: of two that are as good, the shorter offset
    const int steps = step % 2 == 0 ? -step / 2 : (step + 1) / 2;
    auto found = candidate_for(seen, path, camera, steps * kStep_s, tolerance);
    if (found.agreeing > best.agreeing) best = found;
  }
  if (best.agreeing < kLeastAgreeing) return std::nullopt;
  return best.pose;
}

}  // namespace handcast::calib
