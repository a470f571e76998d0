// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/tracker/observations.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr int kLeastSightings = 60;
constexpr double kLeastTime_s = 2;

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  // The difference of the integers may overflow.
  return 1e-9 * (static_cast<double>(to_ns) - static_cast<double>(from_ns));
}

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The usable samples in the order of time, one for each time.
std::vector<const TrackerSample*> sorted(std::span<const TrackerSample> samples) {
  std::vector<const TrackerSample*> usable;
  for (const auto& sample : samples)
    if (std::ranges::all_of(sample.points_m, finite)) usable.push_back(&sample);
  std::ranges::stable_sort(usable, {}, &TrackerSample::time_ns);
  // Not std::ranges::unique(), which clang 14 does not compile.
  const auto same_time = [](const auto* a, const auto* b) { return a->time_ns == b->time_ns; };
  usable.erase(std::unique(usable.begin(), usable.end(), same_time), usable.end());
  return usable;
}

Result<void> check_samples(std::span<const TrackerSample> samples) {
  if (samples.empty()) return fail(Errc::bad_data, "The tracker has no samples.");
  const auto points = samples.front().points_m.size();
  if (points == 0) return fail(Errc::bad_data, "The samples of the tracker have no points.");
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (samples[i].points_m.size() != points)
      return fail(Errc::bad_data,
                  fmt::format("Sample {} of the tracker has {} points, but the first has {}.", i,
                              samples[i].points_m.size(), points));
  return {};
}

Result<std::vector<TimedSighting>> usable_sightings(std::span<const Sighting> sightings, int points,
                                                    std::int64_t begin_ns) {
  std::vector<TimedSighting> usable;
  for (const auto& s : sightings) {
    if (s.point < 0 || s.point >= points)
      return fail(Errc::bad_data, fmt::format("A sighting is of point {}, but the tracker has the "
                                              "points 0 to {}.",
                                              s.point, points - 1));
    if (std::isfinite(s.undistorted_px.x) && std::isfinite(s.undistorted_px.y) &&
        std::isfinite(s.sigma_px) && s.sigma_px > 0)
      usable.push_back(
          {seconds_between(begin_ns, s.time_ns), s.point, s.undistorted_px, s.sigma_px});
  }
  std::ranges::stable_sort(usable, {}, &TimedSighting::time_s);
  std::vector<double> sigmas(usable.size());
  std::ranges::transform(usable, sigmas.begin(), &TimedSighting::sigma);
  const double usual_px = median(std::move(sigmas));
  for (auto& s : usable) s.sigma /= usual_px;
  return usable;
}

/// Mean and covariance of points.
struct Moments {
  double count = 0;
  glm::dvec3 sum{0};
  glm::dmat3 squares{0};

  void add(const glm::dvec3& at) {
    ++count;
    sum += at;
    squares += glm::outerProduct(at, at);
  }
  /// Standard deviations along the principal axes, the largest first.
  glm::dvec3 deviations() const {
    if (count == 0) return glm::dvec3(0);
    const auto covariance = squares / count - glm::outerProduct(sum, sum) / (count * count);
    Eigen::Matrix3d matrix;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) matrix(r, c) = covariance[c][r];
    const Eigen::Vector3d variances =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvalues().cwiseMax(0);
    return {std::sqrt(variances[2]), std::sqrt(variances[1]), std::sqrt(variances[0])};
  }
};

Result<void> check_common_time(const Observations& o) {
  if (o.sightings.size() < kLeastSightings) return check_amount(o);
  const double first_s = o.sightings.front().time_s, last_s = o.sightings.back().time_s;
  if (last_s <= first_s) return fail(Errc::bad_data, "The camera's clock stands still.");
  if (first_s > o.track.end_s() || last_s < o.track.begin_s())
    return fail(Errc::bad_data,
                fmt::format("Camera and tracker have no common time: the tracker's samples last "
                            "from 0 to {:.3f} s, the camera's sightings from {:.3f} to {:.3f} s.",
                            o.track.end_s(), first_s, last_s));
  return {};
}

Result<void> check_extent(const Observations& o) {
  constexpr double kLeastMotion_m = 0.010, kLeastWidth_m = 0.005;
  const auto extent = extent_of(o);
  if (extent.motion_m < kLeastMotion_m)
    return fail(Errc::bad_data,
                fmt::format("The hand hardly moves (standard deviation {:.1f} mm); move it through "
                            "the whole volume.",
                            1000 * extent.motion_m));
  if (extent.axes_m.y < kLeastWidth_m)
    return fail(Errc::bad_data, fmt::format("The points lie on a line, to within {:.1f} mm, which "
                                            "leaves the rotation about it open; move the hand in "
                                            "all directions.",
                                            1000 * extent.axes_m.y));
  return {};
}

}  // namespace

Result<void> check_amount(const Observations& o) {
  if (o.sightings.size() < kLeastSightings)
    return fail(Errc::bad_data, fmt::format("Camera and tracker have {} usable sightings in "
                                            "common; at least {} are needed.",
                                            o.sightings.size(), kLeastSightings));
  const double common_s = o.sightings.back().time_s - o.sightings.front().time_s;
  if (common_s < kLeastTime_s)
    return fail(Errc::bad_data, fmt::format("Camera and tracker have {:.1f} s in common; at least "
                                            "{:.0f} s are needed.",
                                            common_s, kLeastTime_s));
  return {};
}

double angle_between_rad(const TrackerPose& a, const TrackerPose& b) {
  const auto turn = glm::transpose(a.rotation) * b.rotation;
  return std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2, -1., 1.));
}

std::vector<double> Observations::distances_px(const TrackerPose& pose) const {
  std::vector<double> distances;
  distances.reserve(sightings.size());
  for (const auto& s : sightings) {
    const auto moving = track.at(s.point, s.time_s + pose.offset_s);
    const auto at = moving ? pose.apply(moving->at_m) : glm::dvec3(0);
    distances.push_back(!moving    ? std::numeric_limits<double>::quiet_NaN()
                        : at.z > 0 ? glm::distance(camera.project(at), s.px)
                                   : std::numeric_limits<double>::infinity());
  }
  return distances;
}

Result<Observations> observe(const CameraModel& camera, std::span<const TrackerSample> samples,
                             std::span<const Sighting> sightings) {
  if (const auto checked = check_samples(samples); !checked)
    return tl::make_unexpected(checked.error());
  const auto usable = sorted(samples);
  if (usable.empty()) return fail(Errc::bad_data, "No sample of the tracker is finite.");
  if (usable.size() == 1 && samples.size() > 1)
    return fail(Errc::bad_data, "The tracker's clock stands still.");
  const auto begin_ns = usable.front()->time_ns;
  std::vector<double> times_s;
  std::vector<std::vector<glm::dvec3>> points_m;
  for (const auto* sample : usable) {
    times_s.push_back(seconds_between(begin_ns, sample->time_ns));
    points_m.push_back(sample->points_m);
  }
  auto seen =
      usable_sightings(sightings, static_cast<int>(samples.front().points_m.size()), begin_ns);
  if (!seen) return tl::make_unexpected(seen.error());
  Observations o{camera, Track(std::move(times_s), points_m), std::move(*seen)};
  o.unusable_sightings = static_cast<int>(sightings.size() - o.sightings.size());
  o.unusable_samples = static_cast<int>(samples.size() - usable.size());
  if (const auto checked = check_common_time(o); !checked)
    return tl::make_unexpected(checked.error());
  // What is seen while the tracker is silent takes no part.
  std::erase_if(o.sightings, [&](const TimedSighting& s) {
    return !o.track.at(s.point, s.time_s) && !o.track.at(s.point, s.time_s - kSearch_s) &&
           !o.track.at(s.point, s.time_s + kSearch_s);
  });
  if (const auto checked = check_amount(o); !checked) return tl::make_unexpected(checked.error());
  if (const auto checked = check_extent(o); !checked) return tl::make_unexpected(checked.error());
  return o;
}

Extent extent_of(const Observations& o) {
  Moments points, middles;
  double image_s = -std::numeric_limits<double>::infinity();
  for (const auto& s : o.sightings) {
    if (const auto moving = o.track.at(s.point, s.time_s)) points.add(moving->at_m);
    if (s.time_s == image_s) continue;
    image_s = s.time_s;
    glm::dvec3 middle(0);
    for (int p = 0; p < o.track.points(); ++p)
      if (const auto moving = o.track.at(p, image_s))
        middle += moving->at_m / static_cast<double>(o.track.points());
      else
        break;
    if (o.track.at(0, image_s)) middles.add(middle);
  }
  return {points.deviations(), glm::length(middles.deviations())};
}

}  // namespace handcast::calib
