// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::landmarks {

/// Samples a grey image between its pixels. The outside of the image is black; at its edge, the
/// last pixel fades to black over one pixel. Keeps its buffer between images. One thread.
///
/// The four pixels around a sample are stored as one 32-bit word, which a vector unit loads with
/// one gather.
class Bilinear {
 public:
  /// Prepares samples that mostly lie in `rect` of the image. The image must stay valid until the
  /// last sample().
  void prepare(renderer::GreyView image, const renderer::Rect& rect);
  /// Writes the samples at `at`, `at` + `step`, ... to `out`; (0, 0) is the centre of the top-left
  /// pixel. Elements of `out` whose sample is outside the image are left as they are; so are all of
  /// them if `at` or `step` is not finite.
  void sample(glm::vec2 at, glm::vec2 step, std::span<std::uint8_t> out) const;

 private:
  renderer::GreyView image_;
  renderer::Rect inner_;  ///< pixels whose right and lower neighbours are in `rect`, too
  /// For each pixel of `inner_`, row by row: itself, its right, lower and lower right neighbour.
  std::vector<std::uint32_t> fours_;
};

}  // namespace handcast::landmarks
