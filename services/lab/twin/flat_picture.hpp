// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"

namespace handcast::twin {

/// The picture on a flat board, row by row from the top; its edge is the edge of the board. The
/// board's axes: x to the picture's right, y down, z into the board, in metres.
struct FlatPicture {
  /// Size in pixels.
  /// @{
  int width_px = 0;
  int height_px = 0;
  /// @}
  std::vector<std::uint8_t> pixels;  ///< reflectance: 0 black to 255 white paper
  double metres_per_px = 0;
  /// Where the board's (0, 0) is in the picture; (0, 0) is the centre of the top-left pixel.
  glm::dvec2 origin_px{0};

  /// The place of a position in the picture on the board, m.
  glm::dvec2 on_board_m(const glm::dvec2& px) const { return (px - origin_px) * metres_per_px; }
};

/// Errors: bad_data (no pixels, another number of them than the size says, no scale, or no origin).
Result<void> check(const FlatPicture& picture);

/// What the projector shows: grey, row by row from the top, without padding. Borrowed.
struct Light {
  const std::uint8_t* grey = nullptr;  ///< share of the full light, linear: 0 dark to 255; not null
  /// Size in pixels: that of the projector's image.
  /// @{
  int width_px = 0;
  int height_px = 0;
  /// @}
};

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
