// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::landmarks {

/// Samples a grey image between its pixels; towards its edges it becomes black within a pixel.
/// Keeps its buffer. One thread. Where nothing is black a sample needs its four pixels only: they
/// lie together in one word, which a vector unit gathers in one go.
class Bilinear {
 public:
  /// Samples will mostly lie in `rect` of the image, which must outlive them.
  void prepare(renderer::GreyView image, const renderer::Rect& rect);
  /// Samples at `at`, `at` + `step`, ...; (0,0) is the middle of the first pixel. Those beside the
  /// image, or not finite, are left out: `out` keeps what it holds there.
  void sample(glm::vec2 at, glm::vec2 step, std::span<std::uint8_t> out) const;

 private:
  renderer::GreyView image_;
  renderer::Rect inner_;  ///< pixels whose right and lower neighbours are in `rect` too
  std::vector<std::uint32_t>
      fours_;  ///< of `inner_`, row by row: the pixel, right of it, below it, below and right
};

}  // namespace handcast::landmarks
