// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace handcast::calib {

/// A point of the tracker at one time, in the tracker's axes.
struct Moving {
  glm::dvec3 at_m{0};
  glm::dvec3 velocity_m_s{0};
};

/// All points of the tracker over time. Position and velocity at a sample are those of the parabola
/// fitted to the samples within 40 ms (Savitzky and Golay 1964, with the actual times); Hermite's
/// cubic connects the samples. Without the smoothing, the noise of an interpolated position would
/// depend on the phase between two samples, which shifts the clock offset that fits best.
class Track {
 public:
  /// `times_s` ascends strictly; `points_m` has one row of equal length for each time, all finite.
  Track(std::vector<double> times_s, const std::vector<std::vector<glm::dvec3>>& points_m);

  /// Nothing outside the samples, and in gaps of more than 60 ms or three median steps.
  std::optional<Moving> at(int point, double time_s) const;
  double begin_s() const { return times_s_.front(); }
  double end_s() const { return times_s_.back(); }
  /// A hand of the same place and motion, but of the other side: each sample mirrored at the plane
  /// through the knuckle of the middle finger, across the knuckles. Only for MediaPipe's 21 points.
  std::optional<Track> mirrored_hand() const;
  int points() const { return static_cast<int>(nodes_.front().size()); }

 private:
  std::vector<Moving> smoothed(std::size_t sample,
                               const std::vector<std::vector<glm::dvec3>>& points_m) const;

  std::vector<double> times_s_;
  std::vector<std::vector<Moving>> nodes_;  ///< of each sample
  double longest_gap_s_;
};

}  // namespace handcast::calib
