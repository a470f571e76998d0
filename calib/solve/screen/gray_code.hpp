// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "calib/solve/board/grey_view.hpp"
#include "calib/solve/screen/correspondence.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// What the camera saw of the patterns.
struct GrayDecoding {
  std::vector<Correspondence> points;  ///< one for each patch of 8 x 8 camera pixels that was read
  double lit_share = 0;                ///< of the camera's pixels: lit well enough to be read
  double saturated_share = 0;  ///< of the lit pixels: white is 255, so the light is too strong
  /// Of the lit pixels, medians in grey levels: white minus black, and the standard deviation of a
  /// pixel's noise.
  /// @{
  double contrast = 0;
  double noise = 0;
  /// @}
  /// The same for the finest stripes, as a share of white minus black: 0 if blur hides them.
  double stripe_contrast = 0;
  /// How far the edges of stripes lie from where their neighbours put them: median over the patches
  /// of the root mean square, in camera pixels.
  double edge_residual_px = 0;
};

/// Structured light: stripes that tell for each camera pixel which projector pixel lights it. Gray
/// code (Inokuchi et al. 1984): two neighbours differ in one bit, so that a pixel on an edge is
/// read as one side or the other. Each pattern is followed by its inverse; where the two are
/// equally bright is an edge, whatever the board's colour and the room's light. This gives the
/// place of an edge to a fraction of a camera pixel although the finest stripes are several pixels
/// wide.
class GrayCode {
 public:
  /// Size of the projector's picture, and the width of the finest stripes: a power of two, at least
  /// 2. The camera must see these stripes: they should be at least 2 of its pixels wide.
  GrayCode(int width_px, int height_px, int finest_px = 4);

  /// Number of patterns: white, black, then a pattern and its inverse for each bit. The bits of
  /// columns and rows alternate, from the widest to the finest stripes, so that a move of the
  /// camera at any time is found.
  int patterns() const { return 2 + 2 * static_cast<int>(bits_.size()); }
  /// Draws a pattern of 0 and 255 into width_px * height_px bytes.
  void draw(int index, std::uint8_t* pixels) const;
  /// Finds the edges in the camera's images of all patterns, in their order. In each patch of 8 x 8
  /// camera pixels it puts a plane through the projector coordinates of the edges and reads it at
  /// their centre. Pixels with too little contrast or two unsure bits are left out.
  /// Errors: bad_data (wrong number or sizes of images; too dark; the finest stripes are not seen;
  /// the camera or the board moved).
  Result<GrayDecoding> decode(std::span<const GreyView> images) const;

 private:
  friend class GrayDecoder;
  struct Bit {
    bool of_row;  ///< else of the column
    int number;   ///< 0: the lowest
  };

  int width_px_, height_px_;
  int lowest_bit_;  ///< cells, the units of the code, are 2^lowest_bit_ px wide
  std::vector<Bit> bits_;
};

/// How far the images of a pattern and of its inverse are from adding up to those of white and
/// black, as a share of white minus black: the 70th percentile over the brighter half of the lit
/// pixels. Noise and the edges of a print in a trembling hand give 0.05 to 0.3, most if the light
/// is weak; an image of another pattern, taken too early or too late, about 1; a light that
/// flickers what it flickers; a board that moves 1 to 3. 0 if nothing is lit. All images must have
/// the same size.
double pattern_misfit(const GreyView& white, const GreyView& black, const GreyView& pattern,
                      const GreyView& inverse);

/// The misfit above which a pattern should be shown again.
inline constexpr double kMostPatternMisfit = 0.6;

}  // namespace handcast::calib
