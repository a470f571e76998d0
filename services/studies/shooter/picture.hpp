// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/base/image.hpp"
#include "services/studies/base/hand_layout.hpp"
#include "services/studies/shooter/game.hpp"

namespace handcast::study {

/// Draws the game on a hand: on the palm, with the score on the thumb and the lives as bars on the
/// fingers.
class ShooterPicture {
 public:
  /// In pictures of that size; `mesh` is the hand.
  ShooterPicture(const renderer::HandMesh& mesh, int width_px, int height_px)
      : layout_(mesh, width_px, height_px), picture_(width_px, height_px) {}
  /// RGBA8, opaque. `time_s`: for what moves by itself. Valid until the next call.
  renderer::View<const std::uint32_t> draw(const ShooterScene& scene, Face face, double time_s);

 private:
  void stars(const Patch& palm, double time_s);
  void number(int value, const Patch& patch, const glm::vec2& at_mm, float height_mm,
              std::uint32_t colour);

  HandLayout layout_;
  renderer::Texture picture_;
};

}  // namespace handcast::study
