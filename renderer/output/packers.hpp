// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "renderer/output/packing.hpp"

/// The packers, each in a file of its own.
namespace handcast::renderer {

/// Pixels of a row that the packers take at a time: several vectors of the processor.
inline constexpr int kPart = 32;

/// True if all of kPart pixels have alpha 0, as most parts of a row beside a hand.
[[gnu::always_inline]] inline bool is_dark(const std::uint32_t* rgba) {
  std::uint32_t any = 0;
  for (int i = 0; i < kPart; ++i) any |= rgba[i];
  return any >> 24 == 0;
}

/// The last pixels of a row, fewer than kPart, as a whole part: the destructor writes them back.
class LastPart {
 public:
  /// `count` pixels of a drawing, and those of the output frame.
  [[gnu::always_inline]] LastPart(const std::uint32_t* drawing, std::uint32_t* output, int count)
      : output_(output), count_(count) {
    std::copy_n(drawing, count, rgba);
    std::copy_n(output, count, out);
  }
  [[gnu::always_inline]] ~LastPart() { std::copy_n(out, count_, output_); }
  LastPart(const LastPart&) = delete;
  LastPart& operator=(const LastPart&) = delete;

  std::uint32_t rgba[kPart] = {};  ///< dark beyond the last pixel
  std::uint32_t out[kPart] = {};

 private:
  std::uint32_t* output_;
  int count_;
};

std::unique_ptr<Packer> make_grey_plane_packer(const config::Projector& settings, int width_px,
                                               int height_px);
std::unique_ptr<Packer> make_colour_plane_packer(const config::Projector& settings, int width_px,
                                                 int height_px);
std::unique_ptr<Packer> make_quadrant_packer(const config::Projector& settings, int width_px,
                                             int height_px);

}  // namespace handcast::renderer
