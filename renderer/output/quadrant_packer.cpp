// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/clones.hpp"
#include "renderer/output/light.hpp"
#include "renderer/output/luminance.hpp"
#include "renderer/output/packers.hpp"

namespace handcast::renderer {
namespace {

constexpr int kQuadrants = 4;

/// The level of the projector for a luminance, in steps of 16.
using LevelOfLuminance = std::array<std::uint32_t, (kWhiteLuminance >> 4) + 1>;

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

/// Sets the levels of a row in one colour.
HANDCAST_CLONES void set_levels(const std::uint16_t* __restrict light,
                                const std::uint32_t* __restrict levels, int count, int shift,
                                std::uint32_t* __restrict out) {
  for (int x = 0; x < count; ++x) out[x] |= levels[light[x] >> 4] << shift;
}

class QuadrantPacker final : public Packer {
 public:
  QuadrantPacker(const config::Projector& settings, int width_px, int height_px)
      : Packer(width_px, height_px, kQuadrants),
        settings_(settings),
        row_(static_cast<std::size_t>(width_px)) {}

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
    for (int y = region.y0; y < region.y1; ++y) {
      luminances(drawing.row(y) + region.x0, region.width(), row_.data());
      set_levels(row_.data(), levels_.data(), region.width(), shift, part.row(y) + region.x0);
    }
  }
  void set_fade(double fade) override {
    table_ = light_table(settings_, fade);
    levels_ = levels_of(table_);
  }

  config::Projector settings_;
  LightTable table_{};
  LevelOfLuminance levels_{};
  std::vector<std::uint16_t> row_;  ///< luminance of the pixels of a row
};

}  // namespace

std::unique_ptr<Packer> make_quadrant_packer(const config::Projector& settings, int width_px,
                                             int height_px) {
  return std::make_unique<QuadrantPacker>(settings, width_px, height_px);
}

}  // namespace handcast::renderer
