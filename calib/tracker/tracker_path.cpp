// SPDX-License-Identifier: Apache-2.0
#include "calib/tracker/tracker_path.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::calib {
namespace {

constexpr std::int64_t kLongestGap_ns = 60'000'000;

bool is_finite(const TrackerSample& sample) {
  return std::ranges::all_of(sample.points_m, [](const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });
}

}  // namespace

TrackerPath::TrackerPath(std::span<const TrackerSample> samples) {
  for (const auto& sample : samples)
    if (!sample.points_m.empty() && is_finite(sample) &&
        (samples_.empty() || sample.points_m.size() == samples_[0].points_m.size()))
      samples_.push_back(sample);
  std::ranges::stable_sort(samples_, {}, &TrackerSample::time_ns);
  const auto same = std::ranges::unique(samples_, {}, &TrackerSample::time_ns);
  samples_.erase(same.begin(), same.end());
}

std::optional<TrackerPath::Moving> TrackerPath::at(std::int64_t time_ns, int point) const {
  if (point < 0 || point >= points()) return std::nullopt;
  const auto after = std::ranges::lower_bound(samples_, time_ns, {}, &TrackerSample::time_ns);
  if (after == samples_.begin() || after == samples_.end()) return std::nullopt;
  const auto before = after - 1;
  const auto gap_ns = after->time_ns - before->time_ns;
  if (gap_ns > kLongestGap_ns) return std::nullopt;
  const auto i = static_cast<std::size_t>(point);
  const auto way_m = after->points_m[i] - before->points_m[i];
  const double share =
      static_cast<double>(time_ns - before->time_ns) / static_cast<double>(gap_ns);
  return Moving{before->points_m[i] + share * way_m, way_m * (1e9 / static_cast<double>(gap_ns))};
}

}  // namespace handcast::calib
