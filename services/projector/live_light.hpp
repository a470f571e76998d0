// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <utility>

#include "config/keep_out.hpp"
#include "renderer/output/dark_areas.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/projector/brightness.hpp"
#include "services/runtime/live_settings.hpp"

namespace handcast::projector {

/// Where [light] puts the pixels of a picture of this size: the shift, and then the mirror.
inline glm::dmat3 placement(const config::Light& light, int width_px, int height_px) {
  using config::Flip;
  const bool across = light.flip == Flip::horizontal || light.flip == Flip::both,
             down = light.flip == Flip::vertical || light.flip == Flip::both;
  const glm::dmat3 shift(1, 0, 0, 0, 1, 0, light.shift_px[0], light.shift_px[1], 1);
  const glm::dmat3 mirror(across ? -1 : 1, 0, 0, 0, down ? -1 : 1, 0, across ? width_px - 1 : 0,
                          down ? height_px - 1 : 0, 1);
  return mirror * shift;
}

/// What people change in the light while it is on. One thread.
class LiveLight {
 public:
  /// All must outlive the object. `rig`: what the others were made with. `at`: of this projector.
  LiveLight(service::LiveSettings& live, const config::Rig& rig, config::Viewpoint at,
            renderer::Pipeline& pipeline, Brightness& brightness, int width_px, int height_px)
      : live_(live),
        at_(at),
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
    const auto rig = config::rig_at_projector(changed->rig, at_);
    settings_ = rig.projector;
    brightness_.adjust(rig.projector, rig.light, now_ns);
    pipeline_.adjust(rig.cascade, rig.content);
    apply_light(rig.light);
    return true;
  }
  /// True if the light is to stay as it is.
  bool is_frozen() const { return light_.freeze; }
  /// How the picture is mirrored.
  config::Flip flip() const { return light_.flip; }
  /// The settings after the last change.
  const std::optional<config::Projector>& settings() const { return settings_; }

 private:
  void apply_light(const config::Light& light) {
    const auto before = std::exchange(light_, light);
    if (light.flip != before.flip || light.shift_px != before.shift_px)
      pipeline_.aim(placement(light, width_px_, height_px_));
    if (light.keep_out == before.keep_out) return;
    const auto areas = config::parse_keep_out(light.keep_out);  // checked with the rig
    if (areas) pipeline_.keep_dark(renderer::dark_areas(*areas, width_px_, height_px_));
  }

  service::LiveSettings& live_;
  config::Viewpoint at_;
  renderer::Pipeline& pipeline_;
  Brightness& brightness_;
  int width_px_, height_px_;
  config::Light light_;  ///< as it is applied; that of a pipeline at first
  std::optional<config::Projector> settings_;
};

}  // namespace handcast::projector
