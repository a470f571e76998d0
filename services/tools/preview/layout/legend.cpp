// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <string>

#include "services/tools/preview/layout/panels.hpp"

namespace handcast::preview {
namespace {

/// They say what is drawn, not what is lit: the fill, which comes after, darkens B and lights C.
constexpr std::array<std::string_view, kRegions> kNames{"A background", "B drawn beside the hand",
                                                        "C hand not drawn", "D hand drawn"};

/// Share of the hand's pixels; "" without a hand. The background has none.
std::string share_of(const Scene& scene, Region region) {
  const auto pixels = [&](Region of) {
    return static_cast<double>(scene.region_px[static_cast<std::size_t>(of)]);
  };
  const double hand = pixels(Region::unlit) + pixels(Region::lit);
  if (region == Region::background || hand <= 0) return "";
  return fmt::format("{:.1f} %", 100 * pixels(region) / hand);
}

void write_region(Canvas& canvas, glm::vec2 at, const Scene& scene, std::size_t region,
                  double width) {
  const auto colour = theme::kRegion[region].with_alpha(region == 0 ? 0.5f : 1.0f);
  canvas.fill({at.x, at.y - 9, 10, 10}, colour, 2);
  canvas.text(at + glm::vec2(22, 0), kNames[region], theme::kText, theme::kInk);
  canvas.text(at + glm::vec2(width, 0), share_of(scene, static_cast<Region>(region)), theme::kText,
              theme::kQuiet, Align::right);
}

}  // namespace

void draw_legend(Canvas& canvas, const Box& box, const Scene& scene) {
  const double column = (box.width - 2 * theme::kInset_px) / 2;
  for (std::size_t i = 0; i < kRegions; ++i) {
    const std::size_t right = i / 2, below = i % 2;
    const glm::vec2 place(box.x + static_cast<double>(right) * (column + 2 * theme::kInset_px),
                          box.y + 14 + 20.0 * static_cast<double>(below));
    write_region(canvas, place, scene, i, column);
  }
  const glm::vec2 at(box.x, box.y + 62);
  const glm::vec2 other(box.x + column + 2 * theme::kInset_px, box.y + 62);
  const std::array<Line, 1> bone{Line{at + glm::vec2(0, -4), at + glm::vec2(11, -4)}};
  canvas.stroke(bone, theme::kJoints, 1.4);
  canvas.disc(at + glm::vec2(0, -4), 2.4, theme::kJoints);
  canvas.disc(at + glm::vec2(11, -4), 2.4, theme::kJoints);
  canvas.text(at + glm::vec2(22, 0), "joints of the tracker", theme::kText, theme::kInk);
  canvas.ring(other + glm::vec2(5, -4), 6, theme::kSigma, 1.2);
  canvas.disc(other + glm::vec2(5, -4), 2, theme::kLandmarks);
  canvas.text(other + glm::vec2(22, 0), "landmarks, circle of 3 σ", theme::kText, theme::kInk);
}

}  // namespace handcast::preview
