// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

namespace handcast::calib {
namespace {

constexpr int kLandmarks = 21, kFingers = 5, kOfFinger = 4;
constexpr std::array<std::string_view, kFingers> kFingerNames{"thumb", "index finger",
                                                              "middle finger", "ring finger",
                                                              "little finger"};
constexpr std::int64_t kSlice_ns = 250'000'000;

/// The slices of the sightings by time, `length_ns` long each. The sightings are in order of time.
std::vector<std::span<const Judged>> slices_of(std::span<const Judged> judged,
                                               std::int64_t length_ns) {
  std::vector<std::span<const Judged>> slices;
  for (std::size_t first = 0; first < judged.size();) {
    std::size_t last = first;
    while (last < judged.size() &&
           judged[last].seen.time_ns < judged[first].seen.time_ns + length_ns)
      ++last;
    slices.push_back(judged.subspan(first, last - first));
    first = last;
  }
  return slices;
}

double share_that_fits(std::span<const Judged> slice) {
  const auto fits = std::ranges::count_if(slice, &Judged::fits);
  return static_cast<double>(fits) / static_cast<double>(slice.size());
}

int finger_of(int landmark) { return landmark == 0 ? -1 : (landmark - 1) / kOfFinger; }

/// The landmark in whose place this one was seen if two fingers are exchanged.
int exchanged(int landmark, int a, int b) {
  const int finger = finger_of(landmark);
  if (finger == a) return landmark + kOfFinger * (b - a);
  if (finger == b) return landmark - kOfFinger * (b - a);
  return landmark;
}

/// The share of the sightings of two fingers that fit if the two are exchanged.
double share_if_exchanged(std::span<const Judged> slice, const TrackerPath& path,
                          const CameraModel& camera, const PoseAndOffset& fit, double limit_px,
                          int a, int b) {
  int count = 0, fits = 0;
  for (const auto& one : slice) {
    const int finger = finger_of(one.seen.point);
    if (finger != a && finger != b) continue;
    ++count;
    auto other = one.seen;
    other.point = exchanged(one.seen.point, a, b);
    const auto found = difference(other, path, camera, fit, one.place_m);
    fits += found && glm::length(found->error_px) < limit_px;
  }
  return count > 0 ? static_cast<double>(fits) / count : 0;
}

/// The share of the sightings of two fingers that fit as they are.
double share_as_it_is(std::span<const Judged> slice, int a, int b) {
  int count = 0, fits = 0;
  for (const auto& one : slice)
    if (const int finger = finger_of(one.seen.point); finger == a || finger == b) {
      ++count;
      fits += one.fits;
    }
  return count > 0 ? static_cast<double>(fits) / count : 1;
}

}  // namespace

Covered covered_by(std::span<const Judged> judged, const CameraModel& camera) {
  std::set<std::pair<int, int>> cells;
  std::vector<double> depths;
  for (const auto& one : judged) {
    if (!one.fits) continue;
    const glm::dvec2 share =
        one.seen.undistorted_px / glm::dvec2(camera.width_px, camera.height_px);
    const auto cell = glm::clamp(glm::ivec2(glm::floor(3.0 * share)), glm::ivec2(0), glm::ivec2(2));
    cells.emplace(cell.x, cell.y);
    depths.push_back(one.place_m.z);
  }
  if (depths.empty()) return {};
  std::ranges::sort(depths);
  return {static_cast<int>(cells.size()), depths[depths.size() / 20],
          depths[depths.size() - 1 - depths.size() / 20]};
}

std::int64_t begin_of_fit_ns(std::span<const Judged> judged) {
  constexpr double kLeastShare = 1.0 / 3;
  for (const auto& slice : slices_of(judged, kSlice_ns))
    if (share_that_fits(slice) >= kLeastShare) return slice.front().seen.time_ns;
  return judged.empty() ? 0 : judged.front().seen.time_ns;
}

std::vector<std::string> exchanged_fingers(std::span<const Judged> judged, const TrackerPath& path,
                                           const CameraModel& camera, const PoseAndOffset& fit,
                                           double sigma_px) {
  constexpr double kClearly = 0.7, kHardly = 0.3, kLeast_s = 0.3;
  std::vector<std::string> findings;
  if (path.points() != kLandmarks) return findings;
  for (int a = 0; a < kFingers; ++a)
    for (int b = a + 1; b < kFingers; ++b) {
      double seconds = 0;
      for (const auto& slice : slices_of(judged, kSlice_ns))
        if (share_as_it_is(slice, a, b) < kHardly &&
            share_if_exchanged(slice, path, camera, fit, 3 * sigma_px, a, b) > kClearly)
          seconds += 1e-9 * static_cast<double>(kSlice_ns);
      if (seconds >= kLeast_s)
        findings.push_back(fmt::format(
            "for {:.1f} s the {} and the {} were exchanged, by the detector or the tracker; these "
            "points were left out",
            seconds, kFingerNames[static_cast<std::size_t>(a)],
            kFingerNames[static_cast<std::size_t>(b)]));
    }
  return findings;
}

}  // namespace handcast::calib
