// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/mask/mask.hpp"
#include "renderer/predict/projected_pose.hpp"

namespace handcast::renderer {

/// A HandHint with its own seeds and capsules.
struct OwnedHint {
  /// As in HandHint.
  /// @{
  Rect region;
  glm::vec2 wrist_px{0}, to_elbow{0};
  float sure_px = 0, most_px = 0;
  std::array<Capsule, kCapsules> capsules{};
  /// @}
  LandmarkPoints seeds_px{};  ///< HandHint::inside_px

  /// Refers to this object.
  HandHint hint() const {
    return {region, wrist_px, to_elbow, seeds_px, capsules, sure_px, most_px};
  }
};

/// Where a hand is expected in an image: `then`, its pose at the exposure, moved by `offset_px`
/// (Q̂ - P). `has_landmarks`: the offset is that of landmarks, not 0. Empty if the hand is more than
/// half an image outside the image.
std::optional<OwnedHint> make_hint(const calib::Calibration& calibration,
                                   const config::Mask& settings, const ProjectedPose& then,
                                   const LandmarkPoints& offset_px, bool has_landmarks);

}  // namespace handcast::renderer
