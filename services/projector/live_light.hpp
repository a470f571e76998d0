// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/keep_out.hpp"
#include "renderer/output/dark_areas.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/projector/brightness.hpp"
#include "services/runtime/live_settings.hpp"

namespace handcast::projector {

/// What people change in the light while it is on. One thread.
class LiveLight {
 public:
  /// All must outlive the object. `rig`: what the others were made with.
  LiveLight(service::LiveSettings& live, const config::Rig& rig, renderer::Pipeline& pipeline,
            Brightness& brightness, int width_px, int height_px)
      : live_(live),
        pipeline_(pipeline),
        brightness_(brightness),
        width_px_(width_px),
        height_px_(height_px) {
    apply_light(rig.light);
  }

  /// Applies what has changed since the last call; returns whether something has. Call it before
  /// each frame.
  bool follow(std::int64_t now_ns) {
    const auto changed = live_.take();
    if (!changed) return false;
    const auto& rig = changed->rig;
    settings_ = rig.projector;
    brightness_.adjust(rig.projector, rig.light, now_ns);
    pipeline_.adjust(rig.cascade, rig.content);
    apply_light(rig.light);
    return true;
  }
  /// True if the light is to stay as it is.
  bool is_frozen() const { return is_frozen_; }
  /// The settings after the last change.
  const std::optional<config::Projector>& settings() const { return settings_; }

 private:
  void apply_light(const config::Light& light) {
    is_frozen_ = light.freeze;
    if (light.keep_out == keep_out_) return;
    keep_out_ = light.keep_out;
    const auto areas = config::parse_keep_out(keep_out_);  // checked with the rig
    if (areas) pipeline_.keep_dark(renderer::dark_areas(*areas, width_px_, height_px_));
  }

  service::LiveSettings& live_;
  renderer::Pipeline& pipeline_;
  Brightness& brightness_;
  int width_px_, height_px_;
  bool is_frozen_ = false;
  std::vector<std::string> keep_out_;
  std::optional<config::Projector> settings_;
};

}  // namespace handcast::projector
