// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "renderer/content/chart_map.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::bench {

/// What the fill of some frames did at the seams of the texture. Pixels.
struct SeamCounts {
  long lit = 0, filled = 0;
  long seam = 0;   ///< of `filled`: it would be continued by a reflection across a seam, and is not
  long other = 0;  ///< of `filled`: it shows a chart other than that of the nearest lit pixel
  long beside = 0;  ///< of `filled`: it shows what lies beside its chart
  long empty = 0;   ///< of `beside`: farther than content continues its charts

  SeamCounts& operator+=(const SeamCounts& more);
};

/// A painter that has another one draw, and looks at what its fills do.
class SeamCounter final : public renderer::Painter {
 public:
  /// `counts` gets the sums of all fills; `picture` the last frame before its fill and after it,
  /// and what its fills are, side by side. Both outlive the painter.
  SeamCounter(std::unique_ptr<renderer::Painter> painter, SeamCounts& counts,
              renderer::Texture& picture);

  void draw(std::span<const renderer::DrawnHand> hands, renderer::Rect region) override;
  void warp(const renderer::WarpGrid& grid, renderer::Rect from, renderer::Rect region) override {
    painter_->warp(grid, from, region);
  }
  renderer::FillCounts fill(renderer::View<const std::uint8_t> mask, const config::Fill& settings,
                            renderer::Rect region) override;
  void darken(std::span<const renderer::Rect> areas, renderer::Rect region) override {
    painter_->darken(areas, region);
  }
  renderer::View<const std::uint32_t> colour() override { return painter_->colour(); }
  Shown shown(int step) override { return painter_->shown(step); }

 private:
  /// What a fill is, in the picture.
  enum class Kind { continued, at_seam, beside, other };
  /// The nearest chart of the texture, and how far it is, texels. 0: there is none within 32.
  struct Place {
    std::uint8_t chart = 0;
    float away_texels = 0;
  };
  using Places = renderer::Image<Place>;  ///< of 640x400 texels
  static Places places_of(const renderer::HandMesh& hand);
  void show(renderer::Rect region, const std::vector<std::uint32_t>& before,
            const renderer::Image<std::uint32_t>& kinds);

  std::unique_ptr<renderer::Painter> painter_;
  std::array<Places, 2> layouts_;     ///< left, right; empty until one is drawn
  std::vector<const Places*> drawn_;  ///< those of the drawn hands
  SeamCounts& counts_;
  renderer::Texture& picture_;
};

}  // namespace handcast::bench
