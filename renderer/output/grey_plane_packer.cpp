// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "config/sections/sub_frames.hpp"
#include "renderer/base/clones.hpp"
#include "renderer/output/luminance.hpp"
#include "renderer/output/packers.hpp"
#include "renderer/output/plane_limits.hpp"

namespace handcast::renderer {
namespace {

constexpr int kGreyBlock = PlaneLimits<std::uint16_t>::kBlock;
constexpr int kGreyPlanes = config::sub_frames_of(config::Packing::planes_24x1);

/// The bit of a plane in RGBA8.
constexpr std::uint32_t bit_of(int plane) {
  constexpr int kGreen = 8, kRed = 0, kBlue = 16;
  constexpr std::array kColours{kGreen, kRed, kBlue};
  return 1u << (kColours[static_cast<std::size_t>(plane / 8)] + plane % 8);
}

/// The limits of a row in the first of `count` planes.
struct GreyLimits {
  const std::uint16_t* row;
  std::ptrdiff_t to_next_plane;
  int first, count;
};

/// Sets the bits of the planes in kPart pixels, the pixels from `x` on in a row of the region.
[[gnu::always_inline]] inline void set_grey_bits_of_part(const std::uint32_t* rgba,
                                                         const GreyLimits& limits, int x,
                                                         std::uint32_t* __restrict out) {
  if (is_dark(rgba)) return;
  std::uint32_t light[kPart];
  luminances<kPart>(rgba, light);
  const std::uint16_t* limit = limits.row + x % kGreyBlock;
  for (int plane = 0; plane < limits.count; ++plane, limit += limits.to_next_plane) {
    const std::uint32_t bit = bit_of(limits.first + plane);
    for (int i = 0; i < kPart; ++i) out[i] |= light[i] > limit[i] ? bit : 0;
  }
}

/// Sets the bits of the planes in the first `pixels` pixels of a row.
HANDCAST_CLONES void set_grey_bits(const std::uint32_t* rgba, const GreyLimits& limits, int pixels,
                                   std::uint32_t* out) {
  static_assert(kGreyBlock % kPart == 0);
  int x = 0;
  for (; x + kPart <= pixels; x += kPart) set_grey_bits_of_part(rgba + x, limits, x, out + x);
  LastPart last(rgba + x, out + x, pixels - x);
  set_grey_bits_of_part(last.rgba, limits, x, last.out);
}

std::array<std::uint16_t, 256> luminances_of_grey() {
  std::array<std::uint16_t, 256> values{};
  for (std::uint32_t level = 0; level < values.size(); ++level)
    values[level] = luminance(0xff000000u | level * 0x010101u);
  return values;
}

class GreyPlanePacker final : public Packer {
 public:
  GreyPlanePacker(const config::Projector& settings, int width_px, int height_px)
      : Packer(width_px, height_px, 1), limits_(settings, kGreyPlanes, luminances_of_grey()) {}

  void add(View<const std::uint32_t> drawing, Rect region, int first, int count) override {
    region = region.within(drawing.width, drawing.height);
    light(0, region);
    for (int y = region.y0; y < region.y1; ++y)
      set_grey_bits(drawing.row(y) + region.x0,
                    {limits_.row(first, region.x0, y), limits_.to_next_plane(), first, count},
                    region.width(), output().row(y) + region.x0);
  }

 private:
  void set_fade(double fade) override { limits_.set_fade(fade); }

  PlaneLimits<std::uint16_t> limits_;
};

}  // namespace

std::unique_ptr<Packer> make_grey_plane_packer(const config::Projector& settings, int width_px,
                                               int height_px) {
  return std::make_unique<GreyPlanePacker>(settings, width_px, height_px);
}

}  // namespace handcast::renderer
