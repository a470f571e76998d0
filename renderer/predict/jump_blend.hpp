// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Smooths the jumps that new inputs cause in a sequence of landmarks. A jump is held back, up to
/// `blend_px`, and released with exp(-t / blend_ms). Motion is not delayed: a jump is the
/// difference between two estimates for one time, without and with the new input. Call either
/// smooth() or follow() once per frame; a sequence may switch between them. One thread.
class JumpBlend {
 public:
  /// Without a last frame. `blend_ms` 0: nothing is held back.
  JumpBlend(double blend_ms, double blend_px)
      : blend_ms_(static_cast<float>(blend_ms)), blend_px_(static_cast<float>(blend_px)) {}

  /// Target time of the last frame. Empty if there is none within 100 ms of `target_ns`.
  std::optional<std::int64_t> last_ns(std::int64_t target_ns) const;
  /// The landmarks for `target_ns`: `wanted`, with the jump held back. `last_known`: the landmarks
  /// for last_ns() as they are known now. The jump is their difference from the last frame's.
  LandmarkPoints smooth(std::int64_t target_ns, const LandmarkPoints& wanted,
                        const LandmarkPoints& last_known);
  /// The same if the landmarks for last_ns() are not known anew. With `news` (an input arrived
  /// since the last frame) the jump is the difference between `wanted` and the last frame
  /// extrapolated at constant velocity; without `news` there is no jump.
  LandmarkPoints follow(std::int64_t target_ns, const LandmarkPoints& wanted, bool news);
  /// Releases at once what is held back.
  void let_in() { held_back_ = {}; }

 private:
  glm::vec2 bounded(const glm::vec2& jump_px) const;
  LandmarkPoints blended(std::int64_t target_ns, const LandmarkPoints& wanted,
                         const LandmarkPoints& jumps_px);

  float blend_ms_, blend_px_;
  std::optional<std::int64_t> last_ns_;
  LandmarkPoints last_{};            ///< `wanted` of the last frame
  LandmarkPoints velocity_px_ms_{};  ///< of `wanted`, without its jumps
  LandmarkPoints held_back_{};
};

}  // namespace handcast::renderer
