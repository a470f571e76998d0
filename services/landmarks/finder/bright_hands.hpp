// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/mask/run_map.hpp"
#include "services/landmarks/crop/box_filter.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"

namespace handcast::landmarks {

/// A bright part of an image that may be a hand with its arm: regions for a landmark model, one
/// for each direction in which the fingers may point, the most likely one first.
struct BrightHand {
  static constexpr int kDirections = 8;     ///< 45 degrees apart
  std::array<Region, kDirections> regions;  ///< around the widest place of the part
};

/// Searches infrared images for hands without a network: the largest bright parts. The palm is
/// taken to be around the centre of the largest circle in the part; the fingers, to point away from
/// where the part meets the edge of the image (the arm), otherwise along the part. One thread.
class BrightHands {
 public:
  /// At most two, the larger first. Parts on which one of `known` (the points of a hand, image px)
  /// lies are left out. The threshold between dark and bright is that of the mask
  /// (choose_threshold()); an image without two classes has no bright part. Valid until the next
  /// call.
  std::span<const BrightHand> search(renderer::GreyView image, std::span<const Points> known);

 private:
  struct Part {
    std::vector<glm::ivec2> pixels;
    glm::vec2 at_edge{0};  ///< mean of the pixels at the edge of the image
    int edge_pixels = 0;
  };
  /// The largest circle in a part.
  struct Circle {
    glm::vec2 centre;
    float radius;
  };

  std::vector<int> largest_parts(std::span<const Points> known);
  Part read(int root);
  Circle widest_place(const Part& part);
  BrightHand around(const Part& part, const Circle& palm) const;

  BoxFilter smaller_;
  renderer::Image<std::uint8_t> bright_;   ///< of the shrunken image: 0 or 255
  renderer::Image<std::uint16_t> inside_;  ///< distance to the dark, in thirds of a pixel
  renderer::RunMap runs_;
  std::vector<BrightHand> found_;
};

}  // namespace handcast::landmarks
