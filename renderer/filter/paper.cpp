// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/filters.hpp"
#include "renderer/filter/tracker_memory.hpp"

namespace handcast::renderer {
namespace {

/// Q̂_T = Q_{T-t_L} + P_T - P_{T-t_L}, point by point (paper, "Moving Least Squares Deformation"). A
/// missing point keeps its last offset.
class PaperFilter final : public CarryFilter {
 public:
  explicit PaperFilter(bool hindsight) : hindsight_(hindsight) {}

  void detection(std::int64_t, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const TrackerAt& tracker) override {
    if (origin_ns < origin_ns_) return;
    const auto then = tracker_then(tracker, hindsight_ ? nullptr : &memory_, origin_ns);
    if (!then) return;
    origin_ns_ = origin_ns;
    for (int i = 0; i < kLandmarks; ++i) {
      if (!was_seen(seen.points[i])) continue;
      offsets_[i] = position_px(seen.points[i]) - (*then)[i];
      known_[i] = true;
    }
  }

  std::optional<LandmarkPoints> at(std::int64_t, std::int64_t target_ns,
                                   const LandmarkPoints& tracker) override {
    memory_.remember(target_ns, tracker);
    return moved_by(tracker, offsets_, known_);
  }

  void forget() override { known_ = {}; }

 private:
  bool hindsight_;
  TrackerMemory memory_;
  std::array<glm::vec2, kLandmarks> offsets_{};
  std::array<bool, kLandmarks> known_{};
  std::int64_t origin_ns_ = 0;
};

}  // namespace

std::unique_ptr<CarryFilter> make_paper_filter(const config::Filter& settings) {
  return std::make_unique<PaperFilter>(settings.hindsight);
}

}  // namespace handcast::renderer
