// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include "config/sections/sub_frames.hpp"
#include "renderer/base/clones.hpp"
#include "renderer/output/packers.hpp"
#include "renderer/output/plane_limits.hpp"

namespace handcast::renderer {
namespace {

constexpr int kPlanes = config::sub_frames_of(config::Packing::planes_8x3);
constexpr int kBlock = PlaneLimits<std::uint8_t>::kBlock;

/// Copies the pixels of a row; those with alpha 0 are black.
HANDCAST_CLONES void take_lit(const std::uint32_t* __restrict colour, int count,
                              std::uint32_t* __restrict lit) {
  for (int x = 0; x < count; ++x) lit[x] = colour[x] >> 24 != 0 ? colour[x] : 0;
}

/// Sets `bit` in the bytes with a level above the limits, which repeat after kBlock pixels.
HANDCAST_CLONES void set_bit(const std::uint8_t* __restrict level,
                             const std::uint8_t* __restrict limit, int bytes, std::uint8_t bit,
                             std::uint8_t* __restrict out) {
  constexpr int kPeriod = 4 * kBlock;
  for (int x = 0; x < bytes; x += kPeriod) {
    const int part = std::min(kPeriod, bytes - x);
    for (int i = 0; i < part; ++i)
      out[x + i] |= static_cast<std::uint8_t>(level[x + i] > limit[i] ? bit : 0);
  }
}

std::array<std::uint8_t, 256> levels() {
  std::array<std::uint8_t, 256> values{};
  std::iota(values.begin(), values.end(), std::uint8_t{0});
  return values;
}

/// The colours of a pixel are dithered in other planes, so that its luminance changes less.
class ColourPlanePacker final : public Packer {
 public:
  ColourPlanePacker(const config::Projector& settings, int width_px, int height_px)
      : Packer(width_px, height_px, 1),
        limits_(settings, kPlanes, levels()),
        rgba_limits_(4 * kPlanes * static_cast<std::size_t>(limits_.to_next_plane()), 0xff),
        row_(static_cast<std::size_t>(width_px)) {}

  void add(View<const std::uint32_t> drawing, Rect region, int first, int count) override {
    region = region.within(drawing.width, drawing.height);
    light(0, region);
    for (int y = region.y0; y < region.y1; ++y) {
      take_lit(drawing.row(y) + region.x0, region.width(), row_.data());
      for (int plane = first; plane < first + count; ++plane)
        set_bit(reinterpret_cast<const std::uint8_t*>(row_.data()), limits_at(plane, region.x0, y),
                4 * region.width(), static_cast<std::uint8_t>(1 << plane),
                reinterpret_cast<std::uint8_t*>(output().row(y) + region.x0));
    }
  }

 private:
  /// The limits of the bytes of the pixels from (x, y) on.
  std::uint8_t* limits_at(int plane, int x, int y) {
    const int mask = limits_.size() - 1;
    return rgba_limits_.data() +
           4 * (static_cast<std::ptrdiff_t>(plane * limits_.size() + (y & mask)) *
                    limits_.row_size() +
                (x & mask));
  }
  void set_fade(double fade) override {
    constexpr int kApart = 3;
    limits_.set_fade(fade);
    for (int plane = 0; plane < kPlanes; ++plane)
      for (int y = 0; y < limits_.size(); ++y)
        for (int x = 0; x < limits_.row_size(); ++x)
          for (int colour = 0; colour < 3; ++colour)
            limits_at(plane, 0, y)[4 * x + colour] =
                *limits_.row((plane + kApart * colour) % kPlanes, x, y);
  }

  PlaneLimits<std::uint8_t> limits_;
  std::vector<std::uint8_t> rgba_limits_;
  std::vector<std::uint32_t> row_;  ///< the lit pixels of a row
};

}  // namespace

std::unique_ptr<Packer> make_colour_plane_packer(const config::Projector& settings, int width_px,
                                                 int height_px) {
  return std::make_unique<ColourPlanePacker>(settings, width_px, height_px);
}

}  // namespace handcast::renderer
