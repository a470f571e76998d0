// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "services/landmarks/crop/bilinear.hpp"
#include "services/landmarks/crop/box_filter.hpp"
#include "services/landmarks/geometry/region.hpp"

namespace handcast::landmarks {

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
