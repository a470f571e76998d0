#pragma once
#include "renderer/cascade/filters/filters.hpp"

namespace handcast::renderer {

/// A filter that follows Q - P of each point at the detection's own time and adds it to P at the target time. `Track` follows one
/// point: known(), forget(), and what the two functions below do with it.
template <class Track>
class OffsetFilter : public CarryFilter {
 public:
  explicit OffsetFilter(const config::Filter& settings) : settings_(settings) {}

  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen, const TrackerAt& tracker) override {
    const auto then = tracker_then(tracker, settings_.hindsight ? nullptr : &memory_, origin_ns);
    if (!then) return;
    for (int i = 0; i < kLandmarks; ++i)
      if (was_seen(seen.points[i])) update(tracks_[i], origin_ns, position_px(seen.points[i]) - (*then)[i]);
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns, const LandmarkPoints& tracker) override {
    if (!settings_.hindsight) memory_.remember(target_ns, tracker);
    std::array<glm::vec2, kLandmarks> offsets{};
    std::array<bool, kLandmarks> known{};
    for (int i = 0; i < kLandmarks; ++i) {
      known[i] = tracks_[i].known();
      if (known[i]) offsets[i] = offset_at(tracks_[i], target_ns);
    }
    return moved_by(tracker, offsets, known);
  }

  void forget() override {
    for (Track& track : tracks_) track.forget();
  }

 protected:
  virtual void update(Track& track, std::int64_t time_ns, glm::vec2 offset_px) const = 0;
  virtual glm::vec2 offset_at(const Track& track, std::int64_t time_ns) const = 0;
  const config::Filter& settings() const { return settings_; }

 private:
  config::Filter settings_;
  TrackerMemory memory_;
  std::array<Track, kLandmarks> tracks_{};
};

}  // namespace handcast::renderer
