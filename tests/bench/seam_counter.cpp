// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/seam_counter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "renderer/draw/cpu/nearest_pixel.hpp"
#include "services/content/surface_map.hpp"

namespace handcast::bench {

using namespace renderer;

namespace {

constexpr int kWidth = 640, kHeight = 400;  ///< of the texture

/// Of a fill in the picture, by its kind.
constexpr std::array<std::uint32_t, 4> kColours{0xff60b060, 0xff30d0ff, 0xffb08040, 0xff2020ff};

Image<std::uint8_t> plane_of(Rect region) { return {region.width(), region.height()}; }

}  // namespace

SeamCounts& SeamCounts::operator+=(const SeamCounts& more) {
  lit += more.lit;
  filled += more.filled;
  seam += more.seam;
  other += more.other;
  beside += more.beside;
  empty += more.empty;
  return *this;
}

SeamCounter::SeamCounter(std::unique_ptr<Painter> painter, SeamCounts& counts, Texture& picture)
    : painter_(std::move(painter)), counts_(counts), picture_(picture) {}

SeamCounter::Places SeamCounter::places_of(const HandMesh& hand) {
  const ChartMap charts(hand, kWidth, kHeight);
  Places places(kWidth, kHeight);
  Image<std::uint8_t> on(kWidth, kHeight), off(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      places.at(x, y).chart = charts.at(x, y).chart;
      on.at(x, y) = charts.at(x, y).chart != 0;
      off.at(x, y) = charts.at(x, y).chart == 0;
    }
  cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(std::as_const(on).view(), std::as_const(off).view(),
                                      cpu::NearestPixel::kLargestReach))
    places.at(way.x, way.y) = {charts.at(way.x + way.dx, way.y + way.dy).chart,
                               std::sqrt(static_cast<float>(way.squared_px))};
  return places;
}

void SeamCounter::draw(std::span<const DrawnHand> hands, Rect region) {
  drawn_.clear();
  for (const auto& hand : hands) {
    auto& layout = layouts_[static_cast<std::size_t>(hand.mesh->side)];
    if (layout.width() == 0) layout = places_of(*hand.mesh);
    drawn_.push_back(&layout);
  }
  painter_->draw(hands, region);
}

FillCounts SeamCounter::fill(View<const std::uint8_t> mask, const config::Fill& settings,
                             Rect region) {
  const auto drawn = painter_->shown(1);
  Image<SurfaceId> surface = plane_of(region);
  Image<std::uint8_t> lit = plane_of(region), unlit = plane_of(region);
  std::vector<std::uint32_t> before;
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x) {
      const bool is_hand = mask.at(region.x0 + x, region.y0 + y) != 0;
      const SurfaceId id = drawn.surface.at(region.x0 + x, region.y0 + y);
      surface.at(x, y) = is_hand ? id : SurfaceId{0};
      lit.at(x, y) = is_hand && id != 0;
      unlit.at(x, y) = is_hand && id == 0;
      before.push_back(lit.at(x, y) ? painter_->colour().at(region.x0 + x, region.y0 + y) : 0);
    }
  const FillCounts counts = painter_->fill(mask, settings, region);
  const auto shown = painter_->shown(1);
  Image<std::uint32_t> kinds(region.width(), region.height());
  SeamCounts found{.lit = counts.lit};
  cpu::NearestPixel nearest;
  for (const auto& way :
       nearest.find(std::as_const(lit).view(), std::as_const(unlit).view(), settings.reach_px)) {
    const int x = way.x, y = way.y;
    if (shown.surface.at(region.x0 + x, region.y0 + y) == 0) continue;  // faded to nothing
    const int mirror_x = x + 2 * way.dx, mirror_y = y + 2 * way.dy;
    const SurfaceId own = surface.at(x + way.dx, y + way.dy);
    const bool is_inside =
        mirror_x >= 0 && mirror_y >= 0 && mirror_x < region.width() && mirror_y < region.height();
    const SurfaceId mirrored = is_inside ? surface.at(mirror_x, mirror_y) : own;
    const glm::vec2 uv = shown.uv.at(region.x0 + x, region.y0 + y);
    const Place place =
        drawn_[own / 64]->at(std::clamp(static_cast<int>(uv.x * kWidth), 0, kWidth - 1),
                             std::clamp(static_cast<int>(uv.y * kHeight), 0, kHeight - 1));
    const bool is_at_seam = mirrored != 0 && mirrored != own && mirrored / 64 == own / 64,
               is_empty =
                   place.chart == 0 || place.away_texels > content::SurfaceMap::padding_of(kWidth),
               is_other = place.chart != 0 && place.chart != own % 64,
               is_beside = is_empty || place.away_texels > 0;
    ++found.filled;
    found.seam += is_at_seam;
    found.other += is_other;
    found.beside += is_beside;
    found.empty += is_empty;
    const Kind kind = is_other     ? Kind::other
                      : is_at_seam ? Kind::at_seam
                      : is_beside  ? Kind::beside
                                   : Kind::continued;
    kinds.at(x, y) = kColours[static_cast<std::size_t>(kind)];
  }
  counts_ += found;
  show(region, before, kinds);
  return counts;
}

void SeamCounter::show(Rect region, const std::vector<std::uint32_t>& before,
                       const Image<std::uint32_t>& kinds) {
  const int width = region.width(), height = region.height();
  picture_ = Texture(3 * width, height, 0xff000000);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto drawn = before[static_cast<std::size_t>(y * width + x)] | 0xff000000;
      picture_.at(x, y) = drawn;
      picture_.at(width + x, y) = painter_->colour().at(region.x0 + x, region.y0 + y) | 0xff000000;
      picture_.at(2 * width + x, y) =
          kinds.at(x, y) != 0 ? kinds.at(x, y) : (drawn >> 2 & 0x3f3f3f) | 0xff000000;
    }
}

}  // namespace handcast::bench
