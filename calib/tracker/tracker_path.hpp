// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "calib/tracker/sightings.hpp"

namespace handcast::calib {

/// The tracker's points over time.
class TrackerPath {
 public:
  /// Where a point is, and how it moves.
  struct Moving {
    glm::dvec3 place_m;
    glm::dvec3 velocity_m_s;
  };

  /// Takes samples in any order. Those with numbers that are not finite are left out, and those with
  /// another number of points than the first one.
  explicit TrackerPath(std::span<const TrackerSample> samples);

  /// A point at a time between two samples, linear between them; empty if they are more than 60 ms
  /// apart, or there is no such point.
  std::optional<Moving> at(std::int64_t time_ns, int point) const;
  /// Number of points of each sample.
  int points() const { return samples_.empty() ? 0 : static_cast<int>(samples_[0].points_m.size()); }
  bool empty() const { return samples_.empty(); }  ///< true if there is no sample

 private:
  std::vector<TrackerSample> samples_;  ///< in order of time, no two at the same
};

}  // namespace handcast::calib
