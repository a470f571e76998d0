// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace handcast::renderer {

/// A constant-velocity Kalman filter of one point in the image, with white-noise acceleration. x
/// and y share one covariance. A measurement that is off by more than 6 sigma and 25 px is an
/// outlier and left out; the fourth in a row is a jump and restarts the track.
class PointTrack {
 public:
  /// True if there is a measurement.
  bool known() const { return known_; }
  /// Drops all measurements.
  void forget() { known_ = false; }

  /// The parameters of the filter.
  struct Model {
    double process = 0;       ///< spectral density of the acceleration, px^2/s^3
    double noise_px = 1;      ///< standard deviation of a measurement, per axis
    double start_speed2 = 0;  ///< variance of the speed when a track starts, (px/s)^2
  };
  /// Adds a measurement. One that is older than the newest is ignored.
  void update(std::int64_t time_ns, glm::vec2 measured_px, const Model& model);
  /// The position at `time_ns`, extrapolated by at most 60 ms. Before the newest measurement: the
  /// position at that one.
  glm::vec2 at(std::int64_t time_ns) const;

 private:
  void start(std::int64_t time_ns, glm::vec2 position_px, const Model& model);
  void advance(std::int64_t time_ns, double process);

  bool known_ = false;
  std::int64_t time_ns_ = 0;
  glm::vec2 position_px_{0}, velocity_px_s_{0};
  double pp_ = 0, pv_ = 0, vv_ = 0;  ///< covariance: position, position-velocity, velocity
  int outliers_ = 0;
};

}  // namespace handcast::renderer
