// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/filters.hpp"
#include "renderer/filter/point_track.hpp"

namespace handcast::renderer {
namespace {

constexpr double kHandStartSpeed2 = 1e6;  ///< (px/s)^2; a hand may be moving when it is first seen

/// A constant-velocity Kalman filter on the landmarks themselves, without the tracker: the method
/// that the paper compares its own with ("Temporal Filtering"), but with the time of each
/// detection. A point that was never seen gets the mean offset of the others.
class Kalman final : public CarryFilter {
 public:
  explicit Kalman(const config::Filter& settings)
      : model_{settings.motion_process, settings.noise_px, kHandStartSpeed2} {}

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
