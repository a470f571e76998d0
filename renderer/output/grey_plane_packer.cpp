// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "config/sections/sub_frames.hpp"
#include "renderer/base/clones.hpp"
#include "renderer/output/luminance.hpp"
#include "renderer/output/packers.hpp"
#include "renderer/output/plane_limits.hpp"

namespace handcast::renderer {
namespace {

constexpr int kBlock = PlaneLimits<std::uint16_t>::kBlock;
constexpr int kPlanes = config::sub_frames_of(config::Packing::planes_24x1);

/// The bit of a plane in RGBA8.
constexpr std::uint32_t bit_of(int plane) {
  constexpr int kGreen = 8, kRed = 0, kBlue = 16;
  constexpr std::array kColours{kGreen, kRed, kBlue};
  return 1u << (kColours[static_cast<std::size_t>(plane / 8)] + plane % 8);
}

bool is_dark(const std::uint32_t* rgba, int count) {
  std::uint32_t any = 0;
  for (int i = 0; i < count; ++i) any |= rgba[i];
  return any >> 24 == 0;
}

/// A row of a drawing, the output frame, and the limits in the first of `count` planes.
struct Row {
  const std::uint32_t* rgba;
  std::uint32_t* out;
  const std::uint16_t* limits;
  std::ptrdiff_t to_next_plane;
  int first, count;
};

/// Sets the bits of the planes in the first `pixels` pixels of a row. Most of the pixels around a
/// hand are dark; short parts of a row in which all of them are take little time.
HANDCAST_CLONES void set_bits(const Row& row, int pixels) {
  constexpr int kPart = 32;
  static_assert(kBlock % kPart == 0);
  std::uint16_t light[kPart];
  for (int x = 0; x < pixels; x += kPart) {
    const std::uint32_t* rgba = row.rgba + x;
    std::uint32_t* out = row.out + x;
    const int part = std::min(kPart, pixels - x);
    if (is_dark(rgba, part)) continue;
    for (int i = 0; i < part; ++i) light[i] = luminance(rgba[i]);
    for (int plane = 0; plane < row.count; ++plane) {
      const std::uint16_t* limit = row.limits + plane * row.to_next_plane + x % kBlock;
      const std::uint32_t bit = bit_of(row.first + plane);
      for (int i = 0; i < part; ++i) out[i] |= light[i] > limit[i] ? bit : 0;
    }
  }
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
      : Packer(width_px, height_px, 1), limits_(settings, kPlanes, luminances_of_grey()) {}

  void add(View<const std::uint32_t> drawing, Rect region, int first, int count) override {
    region = region.within(drawing.width, drawing.height);
    light(0, region);
    for (int y = region.y0; y < region.y1; ++y)
      set_bits({drawing.row(y) + region.x0, output().row(y) + region.x0,
                limits_.row(first, region.x0, y), limits_.to_next_plane(), first, count},
               region.width());
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
