// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "renderer/base/landmark_points.hpp"

namespace handcast::renderer {

/// Takes the jumps out of a row of landmarks: what a new input changes is held back, up to
/// `blend_px`, and let in again with exp(-t / blend_ms). Motion is not delayed: only what the
/// present knowledge says of the last frame is held against what was known then. Once a frame one
/// of smooth() and follow() is called; a row may go over from the one to the other.
class JumpBlend {
 public:
  JumpBlend(double blend_ms, double blend_px)
      : blend_ms_(static_cast<float>(blend_ms)), blend_px_(static_cast<float>(blend_px)) {}

  /// When the last frame was for; nothing where it is too long ago to be blended with.
  std::optional<std::int64_t> last_ns(std::int64_t target_ns) const;
  /// `last_known`: where the landmarks of the last frame should have been, by what is known now.
  LandmarkPoints smooth(std::int64_t target_ns, const LandmarkPoints& wanted,
                        const LandmarkPoints& last_known);
  /// Where nobody knows that: without `news` there is no jump, with news the jump is against where
  /// the landmarks were heading.
  LandmarkPoints follow(std::int64_t target_ns, const LandmarkPoints& wanted, bool news);
  /// What is held back is let in at once.
  void let_in() { held_back_ = {}; }

 private:
  glm::vec2 bounded(const glm::vec2& jump_px) const;
  LandmarkPoints blended(std::int64_t target_ns, const LandmarkPoints& wanted,
                         const LandmarkPoints& jumps_px);

  float blend_ms_, blend_px_;
  std::optional<std::int64_t> last_ns_;
  LandmarkPoints last_{};            ///< wanted then
  LandmarkPoints velocity_px_ms_{};  ///< of that, jumps apart
  LandmarkPoints held_back_{};
};

}  // namespace handcast::renderer
