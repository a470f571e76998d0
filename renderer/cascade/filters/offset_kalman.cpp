#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/cascade/filters/filters.hpp"

namespace handcast::renderer {
namespace {

constexpr double kStartSpeed2 = 100;      ///< variance of a new offset's speed, (px/s)^2
constexpr double kLongestAhead_s = 0.06;  ///< an offset's drift is followed no further
constexpr float kOutlierSigmas = 6, kOutlier_px = 25;
constexpr int kMostOutliers = 3;  ///< in a row; then it was no outlier but a jump

/// Offset of one landmark: position and velocity of x and y, which share one covariance.
class OffsetTrack {
 public:
  bool known() const { return known_; }
  void forget() { known_ = false; }

  void update(std::int64_t time_ns, glm::vec2 offset_px, double process, double noise_px) {
    const double variance = noise_px * noise_px;
    if (!known_) return start(time_ns, offset_px, variance);
    if (time_ns < time_ns_) return;  // older than what is already in: adds nothing
    advance(time_ns, process);
    const glm::vec2 innovation = offset_px - offset_px_;
    const double innovation_variance = pp_ + variance;
    const float limit_px = std::max(kOutlierSigmas * static_cast<float>(std::sqrt(innovation_variance)), kOutlier_px);
    if (glm::length(innovation) > limit_px) {
      if (++outliers_ > kMostOutliers) start(time_ns, offset_px, variance);
      return;
    }
    outliers_ = 0;
    const double gain_position = pp_ / innovation_variance, gain_velocity = pv_ / innovation_variance;
    offset_px_ += static_cast<float>(gain_position) * innovation;
    velocity_px_s_ += static_cast<float>(gain_velocity) * innovation;
    vv_ -= gain_velocity * pv_;
    pv_ -= gain_position * pv_;
    pp_ -= gain_position * pp_;
  }

  glm::vec2 at(std::int64_t time_ns) const {
    const double ahead_s = std::clamp(ns_to_seconds(time_ns - time_ns_), 0.0, kLongestAhead_s);
    return offset_px_ + velocity_px_s_ * static_cast<float>(ahead_s);
  }

 private:
  void start(std::int64_t time_ns, glm::vec2 offset_px, double variance) {
    *this = OffsetTrack();
    known_ = true;
    time_ns_ = time_ns;
    offset_px_ = offset_px;
    pp_ = variance;
    vv_ = kStartSpeed2;
  }

  /// x += v dt; P = F P F' + q [dt^3/3 dt^2/2; dt^2/2 dt] (white-noise acceleration).
  void advance(std::int64_t time_ns, double process) {
    const double dt = ns_to_seconds(time_ns - time_ns_);
    time_ns_ = time_ns;
    offset_px_ += velocity_px_s_ * static_cast<float>(std::min(dt, kLongestAhead_s));
    pp_ += dt * (2 * pv_ + dt * vv_) + process * dt * dt * dt / 3;
    pv_ += dt * vv_ + process * dt * dt / 2;
    vv_ += process * dt;
  }

  bool known_ = false;
  std::int64_t time_ns_ = 0;
  glm::vec2 offset_px_{0}, velocity_px_s_{0};
  double pp_ = 0, pv_ = 0, vv_ = 0;  ///< covariance: position, position with velocity, velocity
  int outliers_ = 0;
};

/// A constant-velocity Kalman filter on Q - P at the detection's own time (METHOD section 2). A missing point's variance grows. A point
/// beyond 6 sigma and 25 px is left out, up to three in a row.
class OffsetKalman final : public CarryFilter {
 public:
  explicit OffsetKalman(const config::Filter& settings) : settings_(settings) {}

  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen, const TrackerAt& tracker) override {
    const auto then = tracker_then(tracker, settings_.hindsight ? nullptr : &memory_, origin_ns);
    if (!then) return;
    for (int i = 0; i < kLandmarks; ++i)
      if (was_seen(seen.points[i]))
        tracks_[i].update(origin_ns, position_px(seen.points[i]) - (*then)[i], settings_.process, settings_.noise_px);
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns, const LandmarkPoints& tracker) override {
    if (!settings_.hindsight) memory_.remember(target_ns, tracker);
    std::array<glm::vec2, kLandmarks> offsets{};
    std::array<bool, kLandmarks> known{};
    bool any = false;
    for (int i = 0; i < kLandmarks; ++i) {
      known[i] = tracks_[i].known();
      if (known[i]) offsets[i] = tracks_[i].at(target_ns);
      any |= known[i];
    }
    if (!any) return std::nullopt;
    lend_offsets(offsets, known);
    LandmarkPoints points;
    for (int i = 0; i < kLandmarks; ++i) points[i] = tracker[i] + offsets[i];
    return points;
  }

  void forget() override {
    for (OffsetTrack& track : tracks_) track.forget();
  }

 private:
  config::Filter settings_;
  TrackerMemory memory_;
  std::array<OffsetTrack, kLandmarks> tracks_{};
};

}  // namespace

std::unique_ptr<CarryFilter> make_offset_kalman(const config::Filter& settings) { return std::make_unique<OffsetKalman>(settings); }

}  // namespace handcast::renderer
