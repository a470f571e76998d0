// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/point_track.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"

namespace handcast::renderer {
namespace {

constexpr double kLongestAhead_s = 0.06;
constexpr float kOutlierSigmas = 6, kOutlier_px = 25;
constexpr int kMostOutliers = 3;

}  // namespace

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
  vv_ = model.start_speed2;
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

}  // namespace handcast::renderer
