// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/screen_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/solve/screen/resampling.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr double kLeastLever_m = 0.01;
constexpr double kBetter = 1.1, kBetter_px = 0.01;  ///< by which a full model must be better
constexpr double kLittleDepth_m = 0.1;
/// A view that is so much worse than the others has a wrong pose.
constexpr double kMuchWorse = 3, kMuchWorse_px = 0.3;

/// The inliers of all views.
struct Inliers {
  std::vector<Observation> observations;  ///< block: view * kImageBlocks + part of the image
  ProjectorModel start;                   ///< the homography of the first view
  std::size_t points = 0;                 ///< with those that are no inliers

  std::vector<Observation> of_view(int view, bool other_views = false) const {
    std::vector<Observation> chosen;
    for (const auto& observation : observations)
      if ((observation.block / kImageBlocks == view) != other_views) chosen.push_back(observation);
    return chosen;
  }
};

glm::dvec3 ray_of(const CameraModel& camera, const glm::dvec2& px) {
  return {(px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px, 1};
}

Result<void> add_view(Inliers& inliers, const DepthView& view, int number,
                      const CameraModel& camera, double plane_m) {
  const auto found = plane_consensus(view.points, camera, plane_m);
  if (!found) return fail_in(fmt::format("view {}", number + 1), found.error());
  if (number == 0) inliers.start = found->model;
  inliers.points += view.points.size();
  for (auto observation : found->inliers) {
    observation.inverse_depth =
        -glm::dot(glm::dvec3(view.plane), ray_of(camera, observation.camera_px)) / view.plane.w;
    observation.block += number * kImageBlocks;
    if (!(observation.inverse_depth > 0) || !std::isfinite(observation.inverse_depth))
      return fail(Errc::bad_data,
                  fmt::format("view {}: the board is not in front of the camera where the patterns "
                              "were seen: its pose is wrong",
                              number + 1));
    inliers.observations.push_back(observation);
  }
  return {};
}

/// How far the points lie from any single plane, metres: the root mean square of what is left of
/// their inverse depths after the best plane, whose inverse depth is linear in the ray. 0: a
/// homography fits them all, whatever the parallax.
double lever_m(std::span<const Observation> observations, const CameraModel& camera,
               double plane_m) {
  glm::dmat3 normal(0);
  glm::dvec3 right(0);
  for (const auto& point : observations) {
    const auto ray = ray_of(camera, point.camera_px);
    normal += glm::outerProduct(ray, ray);
    right += ray * point.inverse_depth;
  }
  const auto plane = glm::inverse(normal) * right;
  double squares = 0;
  for (const auto& point : observations) {
    const double off = point.inverse_depth - glm::dot(plane, ray_of(camera, point.camera_px));
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(observations.size())) * plane_m * plane_m;
}

/// The errors in each view of fits to the others, for both kinds of models.
struct HeldOut {
  std::vector<double> coaxial_px, full_px;
};

void append(std::vector<double>& residuals_px, const ProjectorModel& model,
            std::span<const Observation> observations) {
  for (const auto& observation : observations)
    residuals_px.push_back(residual_px(model, observation));
}

/// Views without which the parallax is not observable cannot be held out.
HeldOut held_out_by_views(const Inliers& inliers, int views, const CameraModel& camera,
                          const ProjectorModel& full) {
  HeldOut errors;
  for (int view = 0; view < views; ++view) {
    const auto others = inliers.of_view(view, true), here = inliers.of_view(view);
    if (others.empty() || lever_m(others, camera, full.plane_m) < kLeastLever_m) continue;
    append(errors.coaxial_px, refined(full, others, Unknowns::homography), here);
    append(errors.full_px, refined(full, others, Unknowns::everything), here);
  }
  return errors;
}

glm::dvec2 depths_m(std::span<const Observation> observations) {
  const auto [nearest, farthest] =
      std::ranges::minmax_element(observations, std::greater<>(), &Observation::inverse_depth);
  return {1 / nearest->inverse_depth, 1 / farthest->inverse_depth};
}

/// Fits both kinds of models and chooses.
class Choice {
 public:
  Choice(const Inliers& inliers, int views, const CameraModel& camera)
      : inliers_(inliers), views_(views), camera_(camera) {}

  ScreenFit fit(const glm::ivec2& projector_px);

 private:
  void choose(ScreenFit& fit) const;
  void add_intervals(ScreenFit& fit, const glm::ivec2& projector_px) const;
  void add_findings(ScreenFit& fit) const;
  ErrorsPx by_blocks(const ProjectorModel& model, Unknowns unknowns) const {
    const Replicas replicas(model, inliers_.observations, unknowns, views_ * kImageBlocks);
    return errors_of(held_out_by_blocks(replicas, inliers_.observations, views_));
  }

  const Inliers& inliers_;
  int views_;
  const CameraModel& camera_;
};

void Choice::choose(ScreenFit& fit) const {
  const auto& all = inliers_.observations;
  fit.model = refined(inliers_.start, all, Unknowns::homography);
  fit.parallax_observable = lever_m(all, camera_, fit.model.plane_m) >= kLeastLever_m;
  if (!fit.parallax_observable) {
    fit.held_out_coaxial = by_blocks(fit.model, Unknowns::homography);
    return;
  }
  const auto full = refined(fit.model, all, Unknowns::everything);
  const auto held_out = held_out_by_views(inliers_, views_, camera_, full);
  if (held_out.full_px.empty()) {
    fit.held_out_coaxial = by_blocks(fit.model, Unknowns::homography);
    fit.held_out_full = by_blocks(full, Unknowns::everything);
  } else {
    fit.held_out_coaxial = errors_of(held_out.coaxial_px);
    fit.held_out_full = errors_of(held_out.full_px);
  }
  fit.coaxial = !(fit.held_out_coaxial.p95 > kBetter * fit.held_out_full.p95 + kBetter_px);
  if (!fit.coaxial) fit.model = full;
}

void Choice::add_intervals(ScreenFit& fit, const glm::ivec2& projector_px) const {
  const auto& all = inliers_.observations;
  const auto unknowns = fit.coaxial ? Unknowns::homography : Unknowns::everything;
  const Replicas replicas(fit.model, all, unknowns, views_ * kImageBlocks);
  const Bootstrap samples(replicas, all, views_, unknowns);
  fit.corners_px = corners_in_camera(fit.model, projector_px);
  fit.corner_interval_px = samples.corner_intervals(projector_px);
  if (fit.coaxial) return;
  const auto length_mm = [this](const ProjectorModel& model) {
    return 1000 * glm::length(model.centre_m(camera_));
  };
  const Baseline baseline{1000. * fit.model.centre_m(camera_), length_mm(fit.model),
                          samples.interval(length_mm)};
  if (baseline.interval_mm < baseline.length_mm) fit.baseline = baseline;
}

void Choice::add_findings(ScreenFit& fit) const {
  const auto [nearest_m, farthest_m] = std::pair(fit.depths_m.x, fit.depths_m.y);
  if (!fit.parallax_observable)
    fit.findings.push_back(
        fmt::format("All points lie almost in one plane, {:.2f} m to {:.2f} m from the camera, so "
                    "it cannot be told whether "
                    "the projector looks along the camera's axis: the model is right on this "
                    "plane; move the board "
                    "by 0.1 m or more for other depths.",
                    nearest_m, farthest_m));
  else if (farthest_m - nearest_m < kLittleDepth_m)
    fit.findings.push_back(
        fmt::format("The boards were {:.2f} m to {:.2f} m from the camera; farther away from these "
                    "depths the model "
                    "is extrapolated.",
                    nearest_m, farthest_m));
  std::vector<double> medians_px;
  medians_px.reserve(static_cast<std::size_t>(views_));
  for (int view = 0; view < views_; ++view)
    medians_px.push_back(errors_of(fit.model, inliers_.of_view(view)).median);
  // The lower one of two, since one of four views may be wrong.
  const double usual_px = ranked(medians_px, (medians_px.size() - 1) / 2);
  for (int view = 0; view < views_; ++view)
    if (const double off_px = medians_px[static_cast<std::size_t>(view)];
        off_px > kMuchWorse * usual_px + kMuchWorse_px)
      fit.findings.push_back(fmt::format(
          "View {} is off by {:.1f} px, the others by {:.1f} px: is the pose of its board right?",
          view + 1, off_px, usual_px));
}

ScreenFit Choice::fit(const glm::ivec2& projector_px) {
  ScreenFit fit;
  choose(fit);
  fit.inlier_share =
      static_cast<double>(inliers_.observations.size()) / static_cast<double>(inliers_.points);
  fit.residual = errors_of(fit.model, inliers_.observations);
  fit.depths_m = depths_m(inliers_.observations);
  add_intervals(fit, projector_px);
  add_findings(fit);
  return fit;
}

}  // namespace

Result<ScreenFit> fit_screen(std::span<const DepthView> views, const CameraModel& camera,
                             double plane_m, const glm::ivec2& projector_px) {
  if (views.empty()) return fail(Errc::bad_data, "no view of a board was given");
  Inliers inliers;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (const auto added = add_view(inliers, views[i], static_cast<int>(i), camera, plane_m);
        !added)
      return tl::make_unexpected(added.error());
  return Choice(inliers, static_cast<int>(views.size()), camera).fit(projector_px);
}

}  // namespace handcast::calib
