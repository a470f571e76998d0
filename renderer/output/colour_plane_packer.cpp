// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <numeric>

#include "config/sections/sub_frames.hpp"
#include "renderer/base/clones.hpp"
#include "renderer/output/packers.hpp"
#include "renderer/output/plane_limits.hpp"

namespace handcast::renderer {
namespace {

constexpr int kColourPlanes = config::sub_frames_of(config::Packing::planes_8x3);
constexpr int kColourBlock = PlaneLimits<std::uint8_t>::kBlock;

/// The limits of the bytes of a row in the first of `count` planes.
struct ColourLimits {
  const std::uint8_t* row;
  std::ptrdiff_t to_next_plane;
  int first, count;
};

/// Sets the bits of the planes in kPart pixels, the pixels from `x` on in a row of the region.
[[gnu::always_inline]] inline void set_colour_bits_of_part(const std::uint32_t* rgba,
                                                           const ColourLimits& limits, int x,
                                                           std::uint32_t* out) {
  if (is_dark(rgba)) return;
  std::array<std::uint32_t, kPart> lit;
  for (std::size_t i = 0; i < kPart; ++i) lit[i] = rgba[i] >> 24 != 0 ? rgba[i] : 0;
  const auto level = std::bit_cast<std::array<std::uint8_t, 4 * kPart>>(lit);
  auto* bytes = reinterpret_cast<std::uint8_t*>(out);
  const std::uint8_t* limit = limits.row + 4 * (x % kColourBlock);
  for (int plane = 0; plane < limits.count; ++plane, limit += limits.to_next_plane) {
    const auto bit = static_cast<std::uint8_t>(1 << (limits.first + plane));
    std::array<std::uint8_t, 4 * kPart> bits;
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = level[i] > limit[i] ? bit : 0;
    for (std::size_t i = 0; i < bits.size(); ++i) bytes[i] |= bits[i];
  }
}

/// Sets the bits of the planes in the first `pixels` pixels of a row.
HANDCAST_CLONES void set_colour_bits(const std::uint32_t* rgba, const ColourLimits& limits,
                                     int pixels, std::uint32_t* out) {
  static_assert(kColourBlock % kPart == 0);
  int x = 0;
  for (; x + kPart <= pixels; x += kPart) set_colour_bits_of_part(rgba + x, limits, x, out + x);
  LastPart last(rgba + x, out + x, pixels - x);
  set_colour_bits_of_part(last.rgba, limits, x, last.out);
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
        limits_(settings, kColourPlanes, levels()),
        rgba_limits_(4 * kColourPlanes * static_cast<std::size_t>(limits_.to_next_plane()), 0xff) {}

  void add(View<const std::uint32_t> drawing, Rect region, int first, int count) override {
    region = region.within(drawing.width, drawing.height);
    light(0, region);
    for (int y = region.y0; y < region.y1; ++y)
      set_colour_bits(drawing.row(y) + region.x0,
                      {limits_at(first, region.x0, y), 4 * limits_.to_next_plane(), first, count},
                      region.width(), output().row(y) + region.x0);
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
    for (int plane = 0; plane < kColourPlanes; ++plane)
      for (int y = 0; y < limits_.size(); ++y)
        for (int x = 0; x < limits_.row_size(); ++x)
          for (int colour = 0; colour < 3; ++colour)
            limits_at(plane, 0, y)[4 * x + colour] =
                *limits_.row((plane + kApart * colour) % kColourPlanes, x, y);
  }

  PlaneLimits<std::uint8_t> limits_;
  std::vector<std::uint8_t> rgba_limits_;
};

}  // namespace

std::unique_ptr<Packer> make_colour_plane_packer(const config::Projector& settings, int width_px,
                                                 int height_px) {
  return std::make_unique<ColourPlanePacker>(settings, width_px, height_px);
}

}  // namespace handcast::renderer
