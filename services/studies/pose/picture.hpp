// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"
#include "services/studies/base/hand_layout.hpp"
#include "services/studies/pose/game.hpp"

namespace handcast::study {

/// Draws the game on a hand: each bone from red to green by its score, and the wanted pose as a
/// drawing on the palm and on the back.
class PosePicture {
 public:
  PosePicture(const renderer::HandMesh& mesh, int width_px, int height_px);
  /// RGBA8, opaque. `wanted` null: the game is over. Valid until the next call.
  renderer::View<const std::uint32_t> draw(const HeldPose* wanted,
                                           const std::optional<PoseScore>& score);

 private:
  HandLayout layout_;
  renderer::Texture picture_;
  renderer::Image<std::uint8_t> bone_;  ///< by texel: 1 + the bone; 0: none
};

}  // namespace handcast::study
