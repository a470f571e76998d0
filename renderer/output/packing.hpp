// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "config/sections/projector.hpp"
#include "renderer/base/image.hpp"

namespace handcast::renderer {

/// Puts the sub-frames of a projector that shows them one after the other into one output frame
/// (`projector.packing`). Sub-frame k is
///
/// - 24x1: a bit of the output frame: of green (k < 8), red (k < 16) or blue, the lowest bit first,
///   as the DLPC350 numbers its 24 patterns of 1 bit (DLPU010, "Pattern LUT"). It is the luminance
///   of the drawing.
/// - 8x3: bit k of each colour.
/// - quadrants_rgb: a quarter of the output frame: top left, top right, bottom left, bottom right,
///   the order of the PROPixx in its mode QUAD4X (VPixx, "Drawing dots at 480 Hz").
/// - quadrants_grey: the quarter k % 4 of red (k < 4), green (k < 8) or blue, the order of the mode
///   QUAD12X (VPixx, "Drawing dots at 1440 Hz"). It is the luminance of the drawing.
///
/// A bit is lit for a time and has no levels, so the light of 24x1 and 8x3 is dithered (Dither),
/// and the setting `gamma` does not matter. Without `dither`, a pixel is lit if the picture has at
/// least half of the light, and `brightness` is the share of the planes that are lit. One thread.
class Packer {
 public:
  virtual ~Packer() = default;

  /// Begins an output frame, which is dark. `fade`: see light_table().
  void begin(double fade);
  /// Puts the region of a drawing into the sub-frames [first, first + count), which
  /// must be dark.
  virtual void add(View<const std::uint32_t> drawing, Rect region, int first, int count) = 0;

  /// The output frame: the levels that the projector gets, alpha 255; dark outside of region().
  View<const std::uint32_t> image() const { return image_.view(); }
  /// Contains all light of the output frame.
  Rect region() const;

 protected:
  /// `parts`: number of parts of the output frame that are lit and cleared one by one.
  Packer(int width_px, int height_px, int parts);

  /// The output frame, to write into.
  View<std::uint32_t> output() { return image_.view(); }
  /// Notes that a part is lit in `rect`.
  void light(int part, Rect rect) {
    Rect& lit = lit_[static_cast<std::size_t>(part)];
    lit = lit.joined(rect);
  }

 private:
  /// Called if the light of the levels has changed.
  virtual void set_fade(double fade) = 0;

  Texture image_;
  std::vector<Rect> lit_;
  double fade_ = -1;
};

/// A packer for output frames of the given size, both even for quadrants; none if
/// `settings.packing` is none.
std::unique_ptr<Packer> make_packer(const config::Projector& settings, int width_px, int height_px);

}  // namespace handcast::renderer
