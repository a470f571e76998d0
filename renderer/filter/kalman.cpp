// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/filter/filters.hpp"

namespace handcast::renderer {
namespace {

constexpr double kLongestAhead_s = 0.06;
constexpr float kOutlierSigmas = 6, kOutlier_px = 25;
constexpr int kMostOutliers = 3;
/// Variance of the speed when a track starts, (px/s)^2: a hand may be moving when it is first seen.
constexpr double kStartSpeed2 = 1e6;

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
    double process = 0;   ///< spectral density of the acceleration, px^2/s^3
    double noise_px = 1;  ///< standard deviation of a measurement, per axis
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

void PointTrack::update(std::int64_t time_ns, glm::vec2 measured_px, const Model& model) {
  if (!known_) return start(time_ns, measured_px, model);
  if (time_ns < time_ns_) return;
  advance(time_ns, model.process);
  const glm::vec2 innovation = measured_px - position_px_;
  const double innovation_variance = pp_ + model.noise_px * model.noise_px;
  const float limit_px =
      std::max(kOutlierSigmas * static_cast<float>(std::sqrt(innovation_variance)), kOutlier_px);
  if (glm::length(innovation) > limit_px) {
    if (++outliers_ > kMostOutliers) start(time_ns, measured_px, model);
    return;
  }
  outliers_ = 0;
  const double gain_position = pp_ / innovation_variance, gain_velocity = pv_ / innovation_variance;
  position_px_ += static_cast<float>(gain_position) * innovation;
  velocity_px_s_ += static_cast<float>(gain_velocity) * innovation;
  vv_ -= gain_velocity * pv_;
  pv_ -= gain_position * pv_;
  pp_ -= gain_position * pp_;
}

glm::vec2 PointTrack::at(std::int64_t time_ns) const {
  const double ahead_s = std::clamp(ns_to_seconds(time_ns - time_ns_), 0.0, kLongestAhead_s);
  return position_px_ + velocity_px_s_ * static_cast<float>(ahead_s);
}

void PointTrack::start(std::int64_t time_ns, glm::vec2 position_px, const Model& model) {
  *this = PointTrack();
  known_ = true;
  time_ns_ = time_ns;
  position_px_ = position_px;
  pp_ = model.noise_px * model.noise_px;
  vv_ = kStartSpeed2;
}

/// x += v dt; covariance C = F C F' + q [dt^3/3 dt^2/2; dt^2/2 dt], F = [1 dt; 0 1].
void PointTrack::advance(std::int64_t time_ns, double process) {
  const double dt = ns_to_seconds(time_ns - time_ns_);
  time_ns_ = time_ns;
  position_px_ += velocity_px_s_ * static_cast<float>(std::min(dt, kLongestAhead_s));
  pp_ += dt * (2 * pv_ + dt * vv_) + process * dt * dt * dt / 3;
  pv_ += dt * vv_ + process * dt * dt / 2;
  vv_ += process * dt;
}

/// A constant-velocity Kalman filter on the landmarks themselves, without the tracker: the method
/// that the paper compares its own with ("Temporal Filtering"), but with the time of each
/// detection. A point that was never seen gets the mean offset of the others.
class Kalman final : public CarryFilter {
 public:
  explicit Kalman(const config::Filter& settings)
      : model_{settings.motion_process, settings.noise_px} {}

  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const TrackerAt&) override {
    for (int i = 0; i < kLandmarks; ++i)
      if (was_seen(seen.points[i]))
        tracks_[i].update(origin_ns, position_px(seen.points[i]), model_);
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns,
                                   const LandmarkPoints& tracker) override {
    std::array<glm::vec2, kLandmarks> offsets{};
    std::array<bool, kLandmarks> known{};
    for (int i = 0; i < kLandmarks; ++i) {
      known[i] = tracks_[i].known();
      if (known[i]) offsets[i] = tracks_[i].at(target_ns) - tracker[i];
    }
    return moved_by(tracker, offsets, known);
  }

  void forget() override {
    for (PointTrack& track : tracks_) track.forget();
  }

 private:
  PointTrack::Model model_;
  std::array<PointTrack, kLandmarks> tracks_{};
};

}  // namespace

std::unique_ptr<CarryFilter> make_kalman_filter(const config::Filter& settings) {
  return std::make_unique<Kalman>(settings);
}

}  // namespace handcast::renderer
