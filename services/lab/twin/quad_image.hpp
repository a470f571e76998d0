// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/base/image.hpp"

namespace handcast::twin {

/// A grey picture for fast bilinear samples: each element holds a pixel and its neighbours to the
/// right, below and below right, from the lowest byte up. At the edges a pixel is its own
/// neighbour.
class QuadImage {
 public:
  /// Takes over a picture of at least one pixel.
  void assign(renderer::GreyView grey);

  int width() const { return quads_.width(); }
  int height() const { return quads_.height(); }

  /// Samples the picture along a row of the camera's image. Pixel i of the row looks along the ray
  /// (x[i], y[i], 1), and picture_from_ray maps rays to homogeneous pixels of the picture. Sets
  /// inside[i] to 1 and grey[i] to the grey value there, 0 to 1, if that place is in the picture;
  /// else both to 0.
  void sample(const glm::mat3& picture_from_ray, const float* x, const float* y, int count,
              float* grey, float* inside) const;

 private:
  renderer::Image<std::uint32_t> quads_;
};

/// Pictures of falling size: a picture, and each time half of the one before, down to one pixel in
/// one direction. Pixel (u, v) of the picture is (u + 1/2, v + 1/2) / 2^n - 1/2 on level n.
std::vector<QuadImage> make_levels(renderer::GreyView picture);

}  // namespace handcast::twin
