// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "ipc/base/clock.hpp"
#include "renderer/filter/offset_filter.hpp"

namespace handcast::renderer {
namespace {

constexpr float kSpeedCutoff_hz = 1;  ///< of the low-pass on the speed of the offset

/// A low-pass on the offset of one landmark. Its cutoff rises with the speed of the offset.
class OneEuroTrack {
 public:
  bool known() const { return known_; }
  void forget() { known_ = false; }
  glm::vec2 offset_px() const { return offset_px_; }

  void update(std::int64_t time_ns, glm::vec2 measured_px, float least_hz, float per_speed) {
    if (known_ && time_ns <= time_ns_) return;  // arrived late
    if (!known_) {
      *this = OneEuroTrack();
      offset_px_ = measured_px;
    } else {
      const auto step_s = static_cast<float>(ns_to_seconds(time_ns - time_ns_));
      speed_px_s_ +=
          share(kSpeedCutoff_hz, step_s) * ((measured_px - offset_px_) / step_s - speed_px_s_);
      offset_px_ += share(least_hz + per_speed * glm::length(speed_px_s_), step_s) *
                    (measured_px - offset_px_);
    }
    known_ = true;
    time_ns_ = time_ns;
  }

 private:
  /// The share of a new value in a first-order low-pass.
  static float share(float cutoff_hz, float step_s) {
    const float turn = 2 * std::numbers::pi_v<float> * cutoff_hz * step_s;
    return turn / (1 + turn);
  }

  bool known_ = false;
  std::int64_t time_ns_ = 0;
  glm::vec2 offset_px_{0}, speed_px_s_{0};
};

/// The one-euro filter (Casiez, Roussel and Vogel 2012) on Q - P.
class OneEuro final : public OffsetFilter<OneEuroTrack> {
 public:
  using OffsetFilter::OffsetFilter;

 private:
  void update(OneEuroTrack& track, std::int64_t time_ns, glm::vec2 offset_px) const override {
    track.update(time_ns, offset_px, static_cast<float>(settings().one_euro_cutoff_hz),
                 static_cast<float>(settings().one_euro_beta));
  }
  void begin(OneEuroTrack& track, std::int64_t time_ns, glm::vec2 offset_px) const override {
    track.forget();
    update(track, time_ns, offset_px);
  }
  glm::vec2 offset_at(const OneEuroTrack& track, std::int64_t) const override {
    return track.offset_px();
  }
};

}  // namespace

std::unique_ptr<CarryFilter> make_one_euro_filter(const config::Filter& settings) {
  return std::make_unique<OneEuro>(settings);
}

}  // namespace handcast::renderer
