// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace handcast::renderer {

/// A constant-velocity Kalman filter of one point in the image (white-noise acceleration); x and y
/// share one covariance. A measurement beyond 6 sigma and 25 px is left out, up to three in a row:
/// then it was no outlier but a jump.
class PointTrack {
 public:
  bool known() const { return known_; }
  void forget() { known_ = false; }

  /// `start_speed2`: variance of the speed of a track that begins, (px/s)^2. `process`: px^2/s^3. A
  /// measurement older than what is already in adds nothing.
  struct Model {
    double process = 0, noise_px = 1, start_speed2 = 0;
  };
  void update(std::int64_t time_ns, glm::vec2 measured_px, const Model& model);
  /// Begins anew at a position known to `sigma_px`.
  void start(std::int64_t time_ns, glm::vec2 position_px, double sigma_px, const Model& model);

  /// Extrapolated no further than 60 ms.
  glm::vec2 at(std::int64_t time_ns) const;

 private:
  void advance(std::int64_t time_ns, double process);

  bool known_ = false;
  std::int64_t time_ns_ = 0;
  glm::vec2 position_px_{0}, velocity_px_s_{0};
  double pp_ = 0, pv_ = 0, vv_ = 0;  ///< covariance: position, position with velocity, velocity
  int outliers_ = 0;
};

}  // namespace handcast::renderer
