// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "services/landmarks/finder/bilinear.hpp"
#include "services/landmarks/finder/box_filter.hpp"
#include "services/landmarks/finder/region.hpp"

namespace handcast::landmarks {

/// Cuts a region out of a grey image for a network. Keeps its buffers: no allocation once the
/// largest region was seen. One thread.
class Crop {
 public:
  /// The region as side x side pixels, one channel: bilinear, of an image made smaller by a whole
  /// factor first where the region is much larger than the crop. Crop pixel i is the middle of its
  /// cell: place (i + 0.5) / side - 0.5. Black beside the image.
  Crop(int side_px) : side_px_(side_px), pixels_(static_cast<std::size_t>(side_px) * side_px) {}
  void cut(renderer::GreyView image, const Region& region);

  /// How bright the hand is, 0..255: the median of the brighter one of the crop's two parts (Otsu
  /// 1979).
  float level() const;
  std::span<const std::uint8_t> pixels() const { return pixels_; }

  /// Three equal channels 0..1, pixel by pixel, at a gain that brings a hand's level to kHandLevel.
  void write_rgb(std::span<float> rgb) const;
  static constexpr float kHandLevel = 150, kMostGain = 12;

 private:
  int side_px_;
  std::vector<std::uint8_t> pixels_;
  BoxFilter smaller_;
  Bilinear samples_;
};

}  // namespace handcast::landmarks
