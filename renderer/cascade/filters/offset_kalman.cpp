#include "renderer/cascade/filters/filters.hpp"
#include "renderer/cascade/filters/point_track.hpp"

namespace handcast::renderer {
namespace {

constexpr double kStartSpeed2 = 100;  ///< an offset hardly moves: (px/s)^2

/// A constant-velocity Kalman filter on Q - P at the detection's own time (METHOD section 2). A missing point's variance grows.
class OffsetKalman final : public CarryFilter {
 public:
  explicit OffsetKalman(const config::Filter& settings) : settings_(settings) {}

  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen, const TrackerAt& tracker) override {
    const auto then = tracker_then(tracker, settings_.hindsight ? nullptr : &memory_, origin_ns);
    if (!then) return;
    const PointTrack::Model model{settings_.process, settings_.noise_px, kStartSpeed2};
    for (int i = 0; i < kLandmarks; ++i)
      if (was_seen(seen.points[i])) tracks_[i].update(origin_ns, position_px(seen.points[i]) - (*then)[i], model);
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns, const LandmarkPoints& tracker) override {
    if (!settings_.hindsight) memory_.remember(target_ns, tracker);
    std::array<glm::vec2, kLandmarks> offsets{};
    std::array<bool, kLandmarks> known{};
    for (int i = 0; i < kLandmarks; ++i) {
      known[i] = tracks_[i].known();
      if (known[i]) offsets[i] = tracks_[i].at(target_ns);
    }
    return moved_by(tracker, offsets, known);
  }

  void forget() override {
    for (PointTrack& track : tracks_) track.forget();
  }

 private:
  config::Filter settings_;
  TrackerMemory memory_;
  std::array<PointTrack, kLandmarks> tracks_{};
};

}  // namespace

std::unique_ptr<CarryFilter> make_offset_kalman(const config::Filter& settings) { return std::make_unique<OffsetKalman>(settings); }

}  // namespace handcast::renderer
