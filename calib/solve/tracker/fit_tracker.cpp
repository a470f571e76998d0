// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/fit_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/solve/tracker/findings.hpp"
#include "calib/solve/tracker/first_pose.hpp"
#include "calib/solve/tracker/uncertainty.hpp"
#include "ipc/base/clock.hpp"

namespace handcast::calib {
namespace {

/// Sightings within so many scales are reported as fitting: 99.8 % of those with normal errors.
constexpr double kInlier = 3.5;
/// Random sightings reach a few percent.
constexpr double kLeastInliers = 0.15;

/// Mean of the squared distances, each at most kNear_px^2, as in Hypothesis.
double cost_px2(const std::vector<double>& distances_px) {
  double sum = 0, count = 0;
  for (const double distance : distances_px) {
    if (std::isnan(distance)) continue;
    sum += std::min(distance * distance, kNear_px * kNear_px);
    ++count;
  }
  return count > 0 ? sum / count : kNear_px * kNear_px;
}

struct Solution {
  Refined refined;
  double cost_px2 = 0;
};

std::optional<Solution> solve(const Observations& o, const TrackerPose& start) {
  const auto refined = refine(o, start);
  if (!refined) return std::nullopt;
  return Solution{*refined, cost_px2(o.distances_px(refined->pose))};
}

/// From the best hypothesis of each of the best three clock offsets.
std::optional<Solution> best_solution(const Observations& o,
                                      const std::vector<Hypothesis>& hypotheses) {
  constexpr std::size_t kStarts = 3;
  std::vector<double> offsets_s;
  std::optional<Solution> best;
  for (const auto& hypothesis : hypotheses) {
    if (std::ranges::find(offsets_s, hypothesis.pose.offset_s) != offsets_s.end()) continue;
    offsets_s.push_back(hypothesis.pose.offset_s);
    const auto solution = solve(o, hypothesis.pose);
    if (solution && (!best || solution->cost_px2 < best->cost_px2)) best = solution;
    if (offsets_s.size() == kStarts) break;
  }
  return best;
}

/// The angle to a pose with another rotation whose cost is higher by less than half of the mean
/// square of the errors.
std::optional<double> second_pose_rad(const Observations& o,
                                      const std::vector<Hypothesis>& hypotheses,
                                      const Solution& best) {
  constexpr double kApart_rad = 0.17;
  const auto apart = [&](const TrackerPose& pose) {
    return angle_between_rad(pose, best.refined.pose) > kApart_rad;
  };
  const auto other = std::ranges::find_if(hypotheses, apart, &Hypothesis::pose);
  if (other == hypotheses.end()) return std::nullopt;
  const auto second = solve(o, other->pose);
  const double allowed_px2 = best.cost_px2 + best.refined.scale * best.refined.scale;
  if (!second || !apart(second->refined.pose) || second->cost_px2 > allowed_px2)
    return std::nullopt;
  return angle_between_rad(second->refined.pose, best.refined.pose);
}

std::vector<bool> inliers_of(const Observations& o, const Refined& refined) {
  const auto distances = o.distances_px(refined.pose);
  std::vector<bool> inliers;
  for (std::size_t i = 0; i < distances.size(); ++i)
    inliers.push_back(distances[i] < kInlier * refined.scale * o.sightings[i].sigma);
  return inliers;
}

/// Leaves out the times that do not fit, and fits again.
std::vector<MisfitRun> leave_out_misfits(Observations& o, Refined& refined) {
  constexpr int kMostRuns = 3;
  const double begin_s = o.sightings.front().time_s;
  std::vector<MisfitRun> runs;
  for (int i = 0; i < kMostRuns && !o.sightings.empty(); ++i) {
    auto run = misfit_run(o, inliers_of(o, refined));
    if (!run) break;
    const double shift_s = o.sightings.front().time_s - begin_s;
    *run = {run->begin_s + shift_s, run->end_s + shift_s};
    std::erase_if(o.sightings, [&](const TimedSighting& s) {
      const double at_s = s.time_s - begin_s;
      return at_s >= run->begin_s && at_s < run->end_s;
    });
    if (run->begin_s == shift_s) {
      run->begin_s = 0;
      std::erase_if(runs, [](const MisfitRun& r) { return r.begin_s == 0; });  // now in this one
    }
    runs.push_back(*run);
    if (const auto again = refine(o, refined.pose)) refined = *again;
  }
  std::ranges::sort(runs, {}, &MisfitRun::begin_s);
  return runs;
}

Residuals residuals_of(const Observations& o, const TrackerPose& pose,
                       const std::vector<bool>& inliers) {
  const auto distances = o.distances_px(pose);
  std::vector<double> fitting_px;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (inliers[i]) fitting_px.push_back(distances[i]);
  return {percentile_of(fitting_px, 0.5), percentile_of(fitting_px, 0.95)};
}

/// The middle and the corners of the box between the 2nd and the 98th percentiles of the points.
std::array<glm::dvec3, 9> places_of(const Observations& o, const TrackerPose& pose,
                                    const std::vector<bool>& inliers) {
  std::array<std::vector<double>, 3> axes;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    const auto& s = o.sightings[i];
    const auto moving = o.track.at(s.point, s.time_s + pose.offset_s);
    if (!inliers[i] || !moving) continue;
    const auto at = pose.apply(moving->at_m);
    for (int a = 0; a < 3; ++a) axes[static_cast<std::size_t>(a)].push_back(at[a]);
  }
  glm::dvec3 low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = percentile_of(axes[static_cast<std::size_t>(a)], 0.02);
    high[a] = percentile_of(axes[static_cast<std::size_t>(a)], 0.98);
  }
  std::array<glm::dvec3, 9> places{(low + high) / 2.};
  for (std::size_t corner = 0; corner < 8; ++corner)
    places[corner + 1] = {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                          corner & 4 ? high.z : low.z};
  return places;
}

void set_pose(const TrackerPose& pose, TrackerFit& fit) {
  fit.camera_from_tracker = glm::dmat4(pose.rotation);
  fit.camera_from_tracker[3] = glm::dvec4(pose.translation_m, 1);
  fit.clock_offset_ns = seconds_to_ns(pose.offset_s);
}

void set_uncertainty(const Uncertainty& uncertainty, const std::array<glm::dvec3, 9>& places,
                     TrackerFit& fit) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    fit.rotation_deg[a] = uncertainty.spread(axis, glm::degrees(1.));
    fit.camera_place_mm[a] = uncertainty.spread(3 + axis, 1000);
  }
  fit.clock_offset_ms = uncertainty.spread(6, 1000);
  for (std::size_t i = 0; i < places.size(); ++i)
    fit.place_errors[i] = uncertainty.place_error(places[i]);
}

/// The share of the sightings for which the tracker has a position.
double share_of(const std::vector<bool>& inliers, const std::vector<double>& distances_px) {
  const auto seen = std::ranges::count_if(distances_px, [](double d) { return !std::isnan(d); });
  return seen > 0
             ? static_cast<double>(std::ranges::count(inliers, true)) / static_cast<double>(seen)
             : 0;
}

}  // namespace

Result<TrackerFit> fit_tracker(const CameraModel& camera, std::span<const TrackerSample> samples,
                               std::span<const Sighting> sightings) {
  auto observed = observe(camera, samples, sightings);
  if (!observed) return tl::make_unexpected(observed.error());
  const auto hypotheses = first_poses(*observed);
  auto best = best_solution(*observed, hypotheses);
  const double share = best ? share_of(inliers_of(*observed, best->refined),
                                       observed->distances_px(best->refined.pose))
                            : 0;
  Evidence evidence;
  constexpr double kMirrorSuspected = 0.6;
  if (share < kMirrorSuspected)
    evidence.mirrored = mirrored_fit(*observed, best ? best->cost_px2 : kNear_px * kNear_px);
  if (share < kLeastInliers)
    return fail(Errc::bad_data, evidence.mirrored.value_or(fmt::format(
                                    "No pose of the tracker explains more than {:.0f} % of the "
                                    "sightings: camera and tracker did not see the same points.",
                                    100 * share)));
  evidence.second_pose_rad = second_pose_rad(*observed, hypotheses, *best);
  if (!evidence.mirrored) evidence.other_finger = other_finger(*observed, best->refined);

  auto kept = *observed;
  auto& refined = best->refined;
  evidence.runs = leave_out_misfits(kept, refined);
  if (const auto checked = check_amount(kept); !checked)
    return tl::make_unexpected(checked.error());
  const auto inliers = inliers_of(kept, refined);
  const auto uncertainty = uncertainty_of(kept, refined);
  evidence.cover = cover_of(kept, refined.pose, inliers);
  evidence.is_hand = kept.track.points() > 1;
  evidence.plane_m = extent_of(kept).axes_m.z;
  evidence.limit_shift_mm = uncertainty.limit_shift_mm;
  evidence.unusable_sightings = observed->unusable_sightings;
  evidence.unusable_samples = observed->unusable_samples;

  TrackerFit fit;
  set_pose(refined.pose, fit);
  set_uncertainty(uncertainty, places_of(kept, refined.pose, inliers), fit);
  fit.inlier_share = share_of(inliers, observed->distances_px(refined.pose));
  fit.inliers = residuals_of(kept, refined.pose, inliers);
  fit.held_out = held_out(kept, refined);
  judge(evidence, fit);
  return fit;
}

}  // namespace handcast::calib
