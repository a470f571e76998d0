// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/filters.hpp"

namespace handcast::renderer {
namespace {

/// Q as it was seen. A point missing from the newest detection keeps its last position.
class NaiveFilter final : public CarryFilter {
 public:
  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const TrackerAt&) override {
    if (origin_ns < origin_ns_) return;
    origin_ns_ = origin_ns;
    for (int i = 0; i < kLandmarks; ++i) {
      if (!was_seen(seen.points[i])) continue;
      seen_px_[i] = position_px(seen.points[i]);
      known_[i] = true;
    }
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t,
                                   const LandmarkPoints& tracker) override {
    std::array<glm::vec2, kLandmarks> offsets{};
    for (int i = 0; i < kLandmarks; ++i) offsets[i] = seen_px_[i] - tracker[i];
    return moved_by(tracker, offsets, known_);
  }

  void forget() override { *this = NaiveFilter(); }

 private:
  LandmarkPoints seen_px_{};
  std::array<bool, kLandmarks> known_{};
  std::int64_t origin_ns_ = 0;
};

}  // namespace

std::unique_ptr<CarryFilter> make_naive_filter() { return std::make_unique<NaiveFilter>(); }

}  // namespace handcast::renderer
