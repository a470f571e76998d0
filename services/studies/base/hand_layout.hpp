// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::study {

/// The side of a hand that is looked at.
enum class Face { back, palm };

/// A part of a hand that is nearly flat, in its picture: who looks at this face of a hand with its
/// fingers up sees x to the right and y up, in mm from the middle.
struct Patch {
  glm::vec2 middle_px{0};
  glm::mat2 px_per_mm{1};

  glm::vec2 to_px(const glm::vec2& place_mm) const { return middle_px + px_per_mm * place_mm; }
};

/// Where the parts of a hand lie in a picture of it.
class HandLayout {
 public:
  static constexpr std::size_t kFingers = 5;  ///< thumb to little finger

  /// In a picture of that size. `mesh` has vertices on both faces of all fingers.
  HandLayout(const renderer::HandMesh& mesh, int width_px, int height_px);

  /// The palm, or the back of the hand.
  const Patch& palm(Face face) const { return palms_[static_cast<std::size_t>(face)]; }
  /// The last bone of a finger.
  const Patch& tip(std::size_t finger, Face face) const {
    return tips_[static_cast<std::size_t>(face)][finger];
  }

 private:
  std::array<Patch, 2> palms_;
  std::array<std::array<Patch, kFingers>, 2> tips_;
};

/// Paints a square of `size_mm` around a place of a patch: `colour` gives for a place in mm from
/// its middle RGBA8 that is not multiplied by alpha.
template <class Colour>
void paint(renderer::Texture& picture, const Patch& patch, const glm::vec2& at_mm, float size_mm,
           const Colour& colour) {
  const glm::vec2 reach =
      0.5f * size_mm * (glm::abs(patch.px_per_mm[0]) + glm::abs(patch.px_per_mm[1]));
  const glm::vec2 middle = patch.to_px(at_mm);
  const glm::ivec2 first = glm::max(glm::ivec2(glm::floor(middle - reach)), 0);
  const glm::ivec2 last =
      glm::min(glm::ivec2(glm::ceil(middle + reach)), {picture.width() - 1, picture.height() - 1});
  const glm::mat2 mm_per_px = glm::inverse(patch.px_per_mm);
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x) {
      const glm::vec2 place_mm = mm_per_px * (glm::vec2(x, y) - middle);
      if (glm::abs(place_mm.x) > 0.5f * size_mm || glm::abs(place_mm.y) > 0.5f * size_mm) continue;
      const std::uint32_t paint = colour(place_mm), alpha = paint >> 24;
      std::uint32_t& pixel = picture.at(x, y);
      std::uint32_t mixed = 0xff000000u;
      for (int shift = 0; shift < 24; shift += 8)
        mixed |= ((paint >> shift & 0xff) * alpha + (pixel >> shift & 0xff) * (255 - alpha)) / 255
                 << shift;
      pixel = mixed;
    }
}

}  // namespace handcast::study
