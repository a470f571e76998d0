// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/offset_filter.hpp"
#include "renderer/filter/point_track.hpp"

namespace handcast::renderer {
namespace {

constexpr double kOffsetStartSpeed2 = 100;  ///< (px/s)^2; an offset changes slowly
constexpr double kGuess_px = 4;             ///< standard deviation of an offset that is a guess

/// A constant-velocity Kalman filter on Q - P. See `docs/method.md#filter`. The variance of a point
/// grows while it is missing.
class OffsetKalman final : public OffsetFilter<PointTrack> {
 public:
  using OffsetFilter::OffsetFilter;

 private:
  void update(PointTrack& track, std::int64_t time_ns, glm::vec2 offset_px) const override {
    track.update(time_ns, offset_px, model());
  }
  void begin(PointTrack& track, std::int64_t time_ns, glm::vec2 offset_px) const override {
    track.start(time_ns, offset_px, kGuess_px, model());
  }
  glm::vec2 offset_at(const PointTrack& track, std::int64_t time_ns) const override {
    return track.at(time_ns);
  }
  PointTrack::Model model() const {
    return {settings().process, settings().noise_px, kOffsetStartSpeed2};
  }
};

}  // namespace

std::unique_ptr<CarryFilter> make_offset_kalman(const config::Filter& settings) {
  return std::make_unique<OffsetKalman>(settings);
}

}  // namespace handcast::renderer
