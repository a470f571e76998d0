// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/filter/filters.hpp"
#include "renderer/predict/jump_blend.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kFade_ns = 100'000'000;

class SettledFilter final : public LandmarkFilter {
 public:
  SettledFilter(const config::Filter& settings, std::unique_ptr<CarryFilter> inner)
      : settings_(settings),
        inner_(std::move(inner)),
        blend_(settings.blend_ms, settings.blend_px) {}

  void detection(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const TrackerAt& tracker) override {
    if (std::none_of(seen.points.begin(), seen.points.end(), was_seen)) return;
    newest_ns_ = newest_ns_ ? std::max(*newest_ns_, origin_ns) : origin_ns;
    inner_->detection(now_ns, origin_ns, seen, tracker);
    something_new_ = true;
  }

  void tracker_sample(std::int64_t now_ns) override {
    inner_->tracker_sample(now_ns);
    something_new_ = true;
  }

  std::optional<LandmarkPoints> at(std::int64_t now_ns, std::int64_t target_ns,
                                   const LandmarkPoints& tracker) override {
    const auto carried = inner_->at(now_ns, target_ns, tracker);
    const float weight = trust(target_ns);
    LandmarkPoints points = tracker;
    if (carried)
      for (int i = 0; i < kLandmarks; ++i) points[i] = glm::mix(tracker[i], (*carried)[i], weight);
    const bool correcting = carried && weight > 0;
    if (carried && !correcting) start_afresh();
    points = blend_.follow(target_ns, points, something_new_);
    something_new_ = false;
    if (!correcting) blend_.let_in();  // the output was P itself
    return correcting ? std::optional(points) : std::nullopt;
  }

 private:
  /// Weight of the correction: 1 while detections are fresh, then smoothly to 0.
  float trust(std::int64_t target_ns) const {
    if (!newest_ns_) return 0;
    const std::int64_t overdue_ns = target_ns - *newest_ns_ - ms_to_ns(settings_.lost_ms);
    const float t =
        std::clamp(static_cast<float>(overdue_ns) / static_cast<float>(kFade_ns), 0.0f, 1.0f);
    return 1 - t * t * (3 - 2 * t);
  }

  void start_afresh() {
    inner_->forget();
    newest_ns_.reset();
  }

  config::Filter settings_;
  std::unique_ptr<CarryFilter> inner_;
  std::optional<std::int64_t> newest_ns_;  ///< origin of the newest detection
  bool something_new_ = false;
  JumpBlend blend_;
};

}  // namespace

std::unique_ptr<LandmarkFilter> make_settled_filter(const config::Filter& settings,
                                                    std::unique_ptr<CarryFilter> inner) {
  return std::make_unique<SettledFilter>(settings, std::move(inner));
}

}  // namespace handcast::renderer
