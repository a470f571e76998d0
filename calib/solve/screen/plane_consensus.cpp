// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/plane_consensus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr std::size_t kLeastPoints = 20;
constexpr double kLeastShare = 0.6;
constexpr int kTries = 300;  ///< with 60 % inliers all but 1e-18 of the runs find one
constexpr std::size_t kScoredPoints = 500;  ///< on which a sample is judged
constexpr double kAgree_px = 4;             ///< projector px
constexpr int kRounds = 4;                  ///< of fitting and choosing the inliers
constexpr double kInlierSigmas = 4;
constexpr double kLeastSpread_px = 8;  ///< camera px, see spread_px()

/// Maps the corners of the projective frame (the three axes and their sum) to four points.
glm::dmat3 frame_of(const std::array<glm::dvec2, 4>& points) {
  const glm::dmat3 axes(glm::dvec3(points[0], 1), glm::dvec3(points[1], 1),
                        glm::dvec3(points[2], 1));
  const auto scales = glm::inverse(axes) * glm::dvec3(points[3], 1);
  return {axes[0] * scales[0], axes[1] * scales[1], axes[2] * scales[2]};
}

bool is_finite(const glm::dvec2& px) { return std::isfinite(px.x) && std::isfinite(px.y); }
bool is_finite(const glm::dmat3& m) {
  return std::isfinite(glm::dot(m[0] + m[1] + m[2], glm::dvec3(1)));
}

/// The blocks divide the part of the image that the points fill.
std::vector<Observation> observations_of(std::span<const Correspondence> points,
                                         const CameraModel& camera, double plane_m) {
  std::vector<Observation> observations;
  glm::dvec2 first(std::numeric_limits<double>::max()), last = -first;
  for (const auto& point : points) {
    if (!is_finite(point.camera_px) || !is_finite(point.projector_px) || !(point.sigma_px > 0))
      continue;
    const auto px = camera.undistort(point.camera_px);
    observations.push_back({px, 1 / plane_m, point.projector_px, point.sigma_px, 0});
    first = glm::min(first, px);
    last = glm::max(last, px);
  }
  for (auto& observation : observations)
    observation.block = block_of(observation.camera_px, first, last);
  return observations;
}

/// The best of the homographies through four points each.
ProjectorModel best_sample(std::span<const Observation> all, double plane_m) {
  std::mt19937 random(1);  // the same data give the same result
  std::vector<Observation> scored(all.begin(), all.end());
  std::ranges::shuffle(scored, random);
  scored.resize(std::min(scored.size(), kScoredPoints));
  ProjectorModel best{glm::dmat3(1), glm::dvec3(0), plane_m};
  std::ptrdiff_t most = -1;
  for (int sample = 0; sample < kTries; ++sample) {
    std::array<glm::dvec2, 4> from, to;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& point = all[random() % all.size()];
      from[i] = point.camera_px;
      to[i] = point.projector_px;
    }
    const ProjectorModel model{homography_of_corners(from, to), glm::dvec3(0), plane_m};
    if (!is_finite(model.from_camera)) continue;
    const auto agree = std::ranges::count_if(
        scored, [&](const auto& point) { return residual_px(model, point) < kAgree_px; });
    if (agree > most) {
      most = agree;
      best = model;
    }
  }
  return best;
}

/// Residuals in standard deviations; the median tells by how much the stated ones are too small.
std::vector<Observation> inliers_of(const ProjectorModel& model, std::span<const Observation> all) {
  std::vector<double> agreeing;
  for (const auto& point : all)
    if (const double off_px = residual_px(model, point); off_px < kAgree_px)
      agreeing.push_back(off_px / point.sigma_px);
  // The distance of a point in a plane is 1.18 standard deviations of a coordinate in the median.
  const double limit = kInlierSigmas * median(agreeing) / 1.1774 + 1e-6;
  std::vector<Observation> inliers;
  for (const auto& point : all)
    if (residual_px(model, point) < limit * point.sigma_px) inliers.push_back(point);
  return inliers;
}

/// The distance from the line that the points lie nearest to, which a tenth of them exceeds: a few
/// points beside a line do not determine a homography.
double spread_px(std::span<const Observation> points) {
  glm::dvec2 mean(0);
  for (const auto& point : points) mean += point.camera_px / static_cast<double>(points.size());
  double xx = 0, xy = 0, yy = 0;
  for (const auto& point : points) {
    const auto away = point.camera_px - mean;
    xx += away.x * away.x;
    xy += away.x * away.y;
    yy += away.y * away.y;
  }
  const double direction = std::atan2(2 * xy, xx - yy) / 2;
  const glm::dvec2 across(-std::sin(direction), std::cos(direction));
  std::vector<double> distances_px;
  for (const auto& point : points)
    distances_px.push_back(std::abs(glm::dot(across, point.camera_px - mean)));
  return quantile(distances_px, 0.9);
}

tl::unexpected<Error> on_a_line() {
  return fail(Errc::bad_data,
              "the points lie on a line or in one spot of the camera's image: the "
              "board must fill much more of it");
}

}  // namespace

int block_of(const glm::dvec2& px, const glm::dvec2& first_px, const glm::dvec2& last_px) {
  const auto size_px = glm::max(last_px - first_px, 1.);
  const auto part = glm::floor((px - first_px) / size_px * glm::dvec2(kBlocksAcross, kBlocksDown));
  return std::clamp(static_cast<int>(part.y), 0, kBlocksDown - 1) * kBlocksAcross +
         std::clamp(static_cast<int>(part.x), 0, kBlocksAcross - 1);
}

glm::dmat3 homography_of_corners(const std::array<glm::dvec2, 4>& camera_px,
                                 const std::array<glm::dvec2, 4>& projector_px) {
  const auto homography = frame_of(projector_px) * glm::inverse(frame_of(camera_px));
  return homography / homography[2][2];
}

Result<PlaneConsensus> plane_consensus(std::span<const Correspondence> points,
                                       const CameraModel& camera, double plane_m) {
  const auto all = observations_of(points, camera, plane_m);
  if (all.size() < kLeastPoints)
    return fail(Errc::bad_data,
                fmt::format("only {} points of the board were found, but {} are "
                            "needed: do the patterns fall on it, in the camera's view?",
                            all.size(), kLeastPoints));
  if (spread_px(all) < kLeastSpread_px) return on_a_line();
  PlaneConsensus found{best_sample(all, plane_m), {}, 0};
  for (int round = 0; round < kRounds; ++round) {
    found.inliers = inliers_of(found.model, all);
    found.share = static_cast<double>(found.inliers.size()) / static_cast<double>(points.size());
    if (found.share < kLeastShare)
      return fail(Errc::bad_data,
                  fmt::format("only {:.0f} % of the points agree with each other: is the board "
                              "flat, and did the camera or the board move?",
                              100 * found.share));
    if (spread_px(found.inliers) < kLeastSpread_px) return on_a_line();
    found.model = refined(found.model, found.inliers, Unknowns::homography);
  }
  if (!is_finite(found.model.from_camera)) return on_a_line();
  return found;
}

}  // namespace handcast::calib
