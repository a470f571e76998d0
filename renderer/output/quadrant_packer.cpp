// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/clones.hpp"
#include "renderer/output/light.hpp"
#include "renderer/output/luminance.hpp"
#include "renderer/output/packers.hpp"

namespace handcast::renderer {
namespace {

constexpr int kQuadrants = 4;

/// The level of the projector for a luminance, in steps of 16.
using LevelOfLuminance = std::array<std::uint8_t, (kWhiteLuminance >> 4) + 1>;

LevelOfLuminance levels_of(const LightTable& table) {
  LevelOfLuminance levels{};
  std::size_t grey = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    while (grey < 255 &&
           luminance(0xff000000u | static_cast<std::uint32_t>(grey + 1) * 0x010101u) >> 4 <= i)
      ++grey;
    levels[i] = table[grey];
  }
  return levels;
}

/// Sets the levels of kPart pixels in one colour.
[[gnu::always_inline]] inline void set_levels_of_part(const std::uint32_t* rgba,
                                                      const std::uint8_t* levels, int shift,
                                                      std::uint32_t* out) {
  if (is_dark(rgba)) return;
  std::uint32_t light[kPart];
  luminances<kPart>(rgba, light);
  for (int i = 0; i < kPart; ++i)
    out[i] |= static_cast<std::uint32_t>(levels[light[i] >> 4]) << shift;
}

/// Sets the levels of the first `pixels` pixels of a row in one colour.
HANDCAST_CLONES void set_levels(const std::uint32_t* rgba, const std::uint8_t* levels, int pixels,
                                int shift, std::uint32_t* out) {
  int x = 0;
  for (; x + kPart <= pixels; x += kPart) set_levels_of_part(rgba + x, levels, shift, out + x);
  LastPart last(rgba + x, out + x, pixels - x);
  set_levels_of_part(last.rgba, levels, shift, last.out);
}

class QuadrantPacker final : public Packer {
 public:
  QuadrantPacker(const config::Projector& settings, int width_px, int height_px)
      : Packer(width_px, height_px, kQuadrants), settings_(settings) {}

  void add(View<const std::uint32_t> drawing, Rect region, int first, int count) override {
    region = region.within(drawing.width, drawing.height);
    for (int sub_frame = first; sub_frame < first + count; ++sub_frame) {
      const int quadrant = sub_frame % kQuadrants;
      const int left = quadrant % 2 * drawing.width, top = quadrant / 2 * drawing.height;
      light(quadrant, {region.x0 + left, region.y0 + top, region.x1 + left, region.y1 + top});
      const View<std::uint32_t> part{output().row(top) + left, drawing.width, drawing.height,
                                     output().stride};
      if (settings_.packing == config::Packing::quadrants_4)
        write_light(drawing, region, table_, part);
      else
        write_grey(drawing, region, 8 * (sub_frame / kQuadrants), part);
    }
  }

 private:
  void write_grey(View<const std::uint32_t> drawing, Rect region, int shift,
                  View<std::uint32_t> part) {
    for (int y = region.y0; y < region.y1; ++y)
      set_levels(drawing.row(y) + region.x0, levels_.data(), region.width(), shift,
                 part.row(y) + region.x0);
  }
  void set_fade(double fade) override {
    table_ = light_table(settings_, fade);
    levels_ = levels_of(table_);
  }

  config::Projector settings_;
  LightTable table_{};
  LevelOfLuminance levels_{};
};

}  // namespace

std::unique_ptr<Packer> make_quadrant_packer(const config::Projector& settings, int width_px,
                                             int height_px) {
  return std::make_unique<QuadrantPacker>(settings, width_px, height_px);
}

}  // namespace handcast::renderer
