// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/homography_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "calib/solve/screen/resampling.hpp"

namespace handcast::calib {
namespace {

constexpr double kFewInliers = 0.9;
constexpr double kLittleCovered = 0.3;
constexpr double kWideInterval_px = 0.5;
constexpr double kLargeError_px = 1;

double covered_share(std::span<const Observation> observations, const CameraModel& camera) {
  std::set<int> parts;
  for (const auto& observation : observations)
    parts.insert(block_of(observation.camera_px, {0, 0}, {camera.width_px, camera.height_px}));
  return static_cast<double>(parts.size()) / kImageBlocks;
}

double widest_px(const HomographyFit& fit) {
  double widest = 0;
  for (const auto& interval : fit.corner_interval_px)
    widest = std::max({widest, interval.x, interval.y});
  return widest;
}

std::vector<std::string> findings_of(const HomographyFit& fit) {
  std::vector<std::string> findings;
  if (fit.inlier_share < kFewInliers)
    findings.push_back(fmt::format(
        "{:.0f} % of the points do not agree with the others and were left out: is the board flat?",
        100 * (1 - fit.inlier_share)));
  if (fit.covered_share < kLittleCovered)
    findings.push_back(fmt::format(
        "The points cover only {:.0f} % of the camera's image; the fit holds there and not beyond.",
        100 * fit.covered_share));
  if (widest_px(fit) > kWideInterval_px)
    findings.push_back(fmt::format(
        "The corners of the projector's picture are known only to {:.1f} px of the camera.",
        widest_px(fit)));
  if (fit.held_out.median > kLargeError_px)
    findings.push_back(
        fmt::format("The points are off by {:.1f} px of the projector where they were left out of "
                    "the fit: is the "
                    "board flat, and the lens calibrated?",
                    fit.held_out.median));
  if (fit.mirrored)
    findings.push_back(
        "The camera sees the projector's picture mirrored: this is right if one of them looks into "
        "a mirror, else "
        "turn mirroring off in the projector or the camera.");
  return findings;
}

}  // namespace

Result<HomographyFit> fit_homography(std::span<const Correspondence> points,
                                     const CameraModel& camera, const glm::ivec2& projector_px) {
  const auto found = plane_consensus(points, camera, 1);
  if (!found) return tl::make_unexpected(found.error());
  const Replicas replicas(found->model, found->inliers, Unknowns::homography, kImageBlocks);
  HomographyFit fit;
  fit.projector_from_camera = found->model.from_camera;
  fit.inlier_share = found->share;
  fit.residual = errors_of(found->model, found->inliers);
  fit.held_out = errors_of(held_out_by_blocks(replicas, found->inliers, 1));
  fit.corners_px = corners_in_camera(found->model, projector_px);
  fit.corner_interval_px =
      Bootstrap(replicas, found->inliers, 1, Unknowns::homography).corner_intervals(projector_px);
  fit.covered_share = covered_share(found->inliers, camera);
  const auto corners = fit.corners_px;
  const auto right = corners[1] - corners[0], down = corners[3] - corners[0];
  fit.mirrored = right.x * down.y < right.y * down.x;
  fit.findings = findings_of(fit);
  return fit;
}

}  // namespace handcast::calib
