#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/cascade/filters/filters.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kFade_ns = 100'000'000;     ///< how long fading out takes
constexpr std::int64_t kLongGap_ns = 100'000'000;  ///< after this long without output there is nothing to blend with

class SettledFilter final : public LandmarkFilter {
 public:
  SettledFilter(const config::Filter& settings, std::unique_ptr<CarryFilter> inner) : settings_(settings), inner_(std::move(inner)) {}

  void detection(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen, const TrackerAt& tracker) override {
    if (std::none_of(seen.points.begin(), seen.points.end(), was_seen)) return;
    newest_ns_ = newest_ns_ ? std::max(*newest_ns_, origin_ns) : origin_ns;
    inner_->detection(now_ns, origin_ns, seen, tracker);
    something_new_ = true;
  }

  void tracker_sample(std::int64_t now_ns) override {
    inner_->tracker_sample(now_ns);
    something_new_ = true;
  }

  std::optional<LandmarkPoints> at(std::int64_t now_ns, std::int64_t target_ns, const LandmarkPoints& tracker) override {
    const auto carried = inner_->at(now_ns, target_ns, tracker);
    const float weight = trust(target_ns);
    LandmarkPoints points = tracker;
    if (carried)
      for (int i = 0; i < kLandmarks; ++i) points[i] = glm::mix(tracker[i], (*carried)[i], weight);
    const bool correcting = carried && weight > 0;
    if (carried && !correcting) start_afresh();
    blend(target_ns, points, correcting);
    return correcting ? std::optional(points) : std::nullopt;
  }

 private:
  /// 1 while detections are fresh, then smoothly to 0.
  float trust(std::int64_t target_ns) const {
    if (!newest_ns_) return 0;
    const std::int64_t overdue_ns = target_ns - *newest_ns_ - ms_to_ns(settings_.lost_ms);
    const float t = std::clamp(static_cast<float>(overdue_ns) / static_cast<float>(kFade_ns), 0.0f, 1.0f);
    return 1 - t * t * (3 - 2 * t);
  }

  void start_afresh() {
    inner_->forget();
    newest_ns_.reset();
  }

  glm::vec2 bounded(const glm::vec2& jump_px) const {
    const float length = glm::length(jump_px), most = static_cast<float>(settings_.blend_px);
    return length > most ? jump_px * (most / length) : jump_px;
  }

  /// The jump a new input makes against where the old ones were heading is taken back, up to blend_px, and let in again with exp(-t /
  /// blend_ms).
  void blend(std::int64_t target_ns, LandmarkPoints& points, bool correcting) {
    const LandmarkPoints wanted = points;
    const std::int64_t step_ns = target_ns - last_ns_;
    if (!has_last_ || std::abs(step_ns) > kLongGap_ns) {
      held_back_ = {};
      velocity_px_s_ = {};
    } else {
      const auto step_s = static_cast<float>(ns_to_seconds(step_ns));
      const float left = settings_.blend_ms > 0 ? std::exp(-std::max(step_s, 0.0f) * 1e3f / static_cast<float>(settings_.blend_ms)) : 0.0f;
      for (int i = 0; i < kLandmarks; ++i) {
        held_back_[i] *= left;
        if (something_new_ && left > 0) held_back_[i] = bounded(held_back_[i] + last_[i] + velocity_px_s_[i] * step_s - wanted[i]);
        if (!something_new_ && step_ns > 0) velocity_px_s_[i] = (wanted[i] - last_[i]) / step_s;
        points[i] += held_back_[i];
      }
    }
    if (!correcting) held_back_ = {};  // the tracker went out as it was
    last_ = wanted;
    last_ns_ = target_ns;
    has_last_ = true;
    something_new_ = false;
  }

  config::Filter settings_;
  std::unique_ptr<CarryFilter> inner_;
  std::optional<std::int64_t> newest_ns_;  ///< origin of the newest detection
  bool something_new_ = false, has_last_ = false;
  std::int64_t last_ns_ = 0;
  LandmarkPoints last_{};                              ///< the output before blending
  std::array<glm::vec2, kLandmarks> velocity_px_s_{};  ///< of that, between new inputs
  std::array<glm::vec2, kLandmarks> held_back_{};
};

}  // namespace

std::unique_ptr<LandmarkFilter> make_settled_filter(const config::Filter& settings, std::unique_ptr<CarryFilter> inner) {
  return std::make_unique<SettledFilter>(settings, std::move(inner));
}

}  // namespace handcast::renderer
