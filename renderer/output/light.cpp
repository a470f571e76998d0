// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/light.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

constexpr std::uint32_t kOpaque = 0xff000000u;

std::uint32_t through(const LightTable& table, std::uint32_t rgba) {
  return kOpaque | static_cast<std::uint32_t>(table[rgba >> 16 & 0xff]) << 16 |
         static_cast<std::uint32_t>(table[rgba >> 8 & 0xff]) << 8 | table[rgba & 0xff];
}

bool changes_nothing(const LightTable& table) {
  for (std::size_t level = 0; level < table.size(); ++level)
    if (table[level] != level) return false;
  return true;
}

}  // namespace

LightTable light_table(const config::Projector& settings, double fade) {
  const double factor = settings.brightness * std::clamp(fade, 0., 1.);
  LightTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double light = factor * srgb_light(static_cast<double>(i) / 255);
    const double level =
        settings.gamma == 0 ? srgb_level(light) : std::pow(light, 1 / settings.gamma);
    table[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(level, 0., 1.)));
  }
  return table;
}

std::array<float, 256> light_of_levels() {
  std::array<float, 256> light{};
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = static_cast<float>(srgb_light(static_cast<double>(i) / 255));
  return light;
}

void write_light(View<const std::uint32_t> frame, Rect region, const LightTable& table,
                 View<std::uint32_t> out) {
  region = region.within(frame.width, frame.height);
  const bool as_it_is = changes_nothing(table);
  for (int y = region.y0; y < region.y1; ++y) {
    const std::uint32_t* from = frame.row(y);
    std::uint32_t* to = out.row(y);
    if (as_it_is)
      for (int x = region.x0; x < region.x1; ++x)
        to[x] = kOpaque | (from[x] >> 24 != 0 ? from[x] : 0);
    else
      for (int x = region.x0; x < region.x1; ++x)
        to[x] = from[x] >> 24 != 0 ? through(table, from[x]) : kOpaque;
  }
}

}  // namespace handcast::renderer
