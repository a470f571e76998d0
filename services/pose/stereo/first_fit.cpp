// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/first_fit.hpp"

#include <algorithm>
#include <cmath>

#include "services/pose/lift/fit.hpp"
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {
namespace {

constexpr int kFirstFitSteps = 20;

/// Pairs of landmarks in a palm whose distance tells how far away it is.
constexpr std::array<std::array<int, 2>, 4> kPalmBones{{{0, 5}, {0, 9}, {0, 17}, {5, 17}}};

/// Distance of the hand from a view that alone sees it, by its size: that of the bone that is least
/// foreshortened.
double depth_by_size(const Skeleton& skeleton, const View& view, const SeenHand& seen,
                     double log_size) {
  double depth_m = 10;
  const double focal_px = std::min(view.camera.fx_px, view.camera.fy_px);
  for (const auto& [a, b] : kPalmBones) {
    const double model_m = glm::distance(skeleton.at_rest_m(msg::kJointOfLandmark[a]),
                                         skeleton.at_rest_m(msg::kJointOfLandmark[b])),
                 seen_px = glm::distance(seen.px[a], seen.px[b]);
    depth_m = std::min(depth_m, focal_px * model_m * std::exp(log_size) / std::max(seen_px, 1.0));
  }
  return std::max(depth_m, 2 * View::kNearest_m);
}

/// Distance of the hand from the first camera: the mean of its triangulated landmarks, by their
/// variance. Empty if none can be triangulated.
std::optional<double> triangulated_depth(const Views& views, const SeenInViews& seen) {
  double sum = 0, weights = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    if (!(seen[0]->sigma_px[i] > 0) || !(seen[1]->sigma_px[i] > 0)) continue;
    const std::array sights{Sight{&views[0], seen[0]->px[i], seen[0]->sigma_px[i]},
                            Sight{&views[1], seen[1]->px[i], seen[1]->sigma_px[i]}};
    const auto point = triangulate(sights);
    if (!point) continue;
    const double weight = 1 / point->covariance_m2[2][2];
    sum += weight * point->place_m.z;
    weights += weight;
  }
  if (!(weights > 0)) return std::nullopt;
  return sum / weights;
}

/// A posture in the space of a view, `depth_m` in front of it, as a state.
HandState state_of(const View& view, Posture posture, double depth_m, const HandState& bones) {
  const glm::dmat4 first_from_view = glm::inverse(view.view_from_first);
  const glm::dvec3 palm_m(first_from_view * glm::dvec4(posture.palm_m, depth_m, 1));
  posture.turn = glm::normalize(glm::quat_cast(glm::dmat3(first_from_view)) * posture.turn);
  posture.palm_m = glm::dvec2(palm_m);
  return {posture, palm_m.z, bones.log_bone};
}

}  // namespace

bool sees_both(const SeenInViews& seen) {
  return std::ranges::all_of(seen, [](const auto& view) { return view.has_value(); });
}

bool sees_all(const SeenInViews& seen) {
  constexpr auto kNearlyAll = msg::kLandmarks - 3;
  return sees_both(seen) && std::ranges::all_of(seen, [](const auto& view) {
           return std::ranges::count_if(view->sigma_px, [](double s) { return s > 0; }) >=
                  kNearlyAll;
         });
}

std::optional<HandFit> first_fit(const Skeleton& skeleton, const Views& views,
                                 const SeenInViews& seen, const HandPrior& bones) {
  if (!seen[0] && !seen[1]) return std::nullopt;
  const double log_size = bones.mean.posture.log_size;
  const int from = seen[0] ? 0 : 1;
  const auto depth_m = sees_both(seen)
                           ? triangulated_depth(views, seen)
                           : depth_by_size(skeleton, views[from], *seen[from], log_size);
  if (!depth_m) return std::nullopt;
  std::optional<HandFit> best;
  for (const Posture& posture :
       starts_for(skeleton, views[from].camera, *depth_m, *seen[from], log_size)) {
    const HandState start = state_of(views[from], posture, *depth_m, bones.mean);
    const HandFit fit = fit_views(skeleton, views, seen, bones, start, kFirstFitSteps);
    if (!best || fit.cost < best->cost) best = fit;
  }
  return best;
}

}  // namespace handcast::pose::stereo
