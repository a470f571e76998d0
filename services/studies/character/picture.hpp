// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>

#include "renderer/base/image.hpp"
#include "services/studies/base/hand_layout.hpp"
#include "services/studies/character/game.hpp"

namespace handcast::study {

/// Draws the game on a hand.
class CharacterPicture {
 public:
  /// In pictures of that size; `mesh` is the hand.
  CharacterPicture(const renderer::HandMesh& mesh, int width_px, int height_px);
  /// RGBA8, opaque. `face`: the one that is played on. Valid until the next call.
  renderer::View<const std::uint32_t> draw(const CharacterScene& scene, Face face);

 private:
  void letter(char character, const Patch& patch, const glm::vec2& at_mm, float size_mm,
              std::uint32_t colour);

  HandLayout layout_;
  renderer::Texture picture_;
  std::map<char, renderer::Texture> letters_;
};

}  // namespace handcast::study
