// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "services/landmarks/crop/box_filter.hpp"
#include "services/landmarks/geometry/region.hpp"

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

/// Resamples a region of a grey image to the square input of a network. Keeps its buffers: it
/// allocates only for a region larger than all before. One thread.
class Crop {
 public:
  /// `side_px`: pixels along each side of the crop.
  explicit Crop(int side_px)
      : side_px_(side_px), pixels_(static_cast<std::size_t>(side_px) * side_px) {}

  /// Fills the crop with the region: side x side pixels, one channel, bilinear, black outside the
  /// image. A region much larger than the crop is first shrunk by a whole factor. Crop pixel i is
  /// the centre of its cell, at the region's place (i + 0.5) / side - 0.5.
  void cut(renderer::GreyView image, const Region& region);

  /// The brightness of the hand, 0..255: the median of the brighter of the crop's two classes of
  /// pixels (Otsu 1979).
  float level() const;
  /// The crop, row by row; valid until the next cut().
  std::span<const std::uint8_t> pixels() const { return pixels_; }

  /// Writes three equal channels 0..1, pixel by pixel. The gain brings level() to kHandLevel, but
  /// is kMostGain at most.
  void write_rgb(std::span<float> rgb) const;
  static constexpr float kHandLevel = 150;  ///< brightness after the gain, 0..255
  static constexpr float kMostGain = 12;    ///< largest gain

 private:
  int side_px_;
  std::vector<std::uint8_t> pixels_;
  BoxFilter smaller_;
  Bilinear samples_;
};

}  // namespace handcast::landmarks
