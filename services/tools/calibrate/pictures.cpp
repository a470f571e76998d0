// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "services/tools/page/html.hpp"

namespace handcast::calibrate {
namespace {

constexpr int kCell_px = 10, kGap_px = 20, kText_px = 24;  ///< of the pictures of errors

/// One depth of errors_svg(). `largest_px`: what is drawn darkest.
std::string depth_svg(const calib::ErrorVolume& errors, std::size_t depth, double largest_px) {
  constexpr double kInvisible = 0.005;
  std::string svg;
  double largest_here_px = 0;
  for (int row = 0; row < errors.rows; ++row)
    for (int column = 0; column < errors.columns; ++column) {
      const double error_px = errors.at(depth, row, column);
      largest_here_px = std::max(largest_here_px, error_px);
      if (const double shade = error_px / std::max(largest_px, 1e-9); shade > kInvisible)
        svg += fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill-opacity='{:.2f}'/>",
                           column * kCell_px, row * kCell_px, kCell_px, kCell_px, shade);
    }
  return svg + fmt::format("<text x='2' y='{}' font-size='14'>{:.2f} m: up to {:.1f} px</text>",
                           errors.rows * kCell_px + 17, errors.depths_m[depth], largest_here_px);
}

}  // namespace

std::string errors_svg(const calib::ErrorVolume& errors, std::string_view caption) {
  const int width_px = errors.columns * kCell_px + kGap_px, height_px = errors.rows * kCell_px;
  const double largest_px = errors.error_px.empty() ? 0 : std::ranges::max(errors.error_px);
  const auto depths = static_cast<int>(errors.depths_m.size());
  auto svg = fmt::format("<figure><svg width='{0}' viewBox='0 0 {0} {1}'>", depths * width_px,
                         height_px + kText_px);
  for (int depth = 0; depth < depths; ++depth)
    svg += fmt::format("<g transform='translate({} 0)'>{}</g>", depth * width_px,
                       depth_svg(errors, static_cast<std::size_t>(depth), largest_px));
  return svg + fmt::format("</svg><figcaption>{}</figcaption></figure>", page::escape(caption));
}

std::string dots_svg(int width_px, int height_px, std::span<const glm::dvec2> dots_px,
                     std::string_view caption) {
  constexpr std::size_t kMost = 2000;
  const auto every = 1 + dots_px.size() / kMost;
  auto svg = fmt::format("<figure><svg class='image' width='{0}' viewBox='-0.5 -0.5 {0} {1}'>",
                         width_px, height_px);
  // As large in the images of all cameras.
  const double radius = width_px / 400.0;
  for (std::size_t i = 0; i < dots_px.size(); i += every)
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}'/>", dots_px[i].x, dots_px[i].y,
                       radius);
  return svg + fmt::format(
                   "</svg><figcaption>{} The frame is the image, {} x {} px.</figcaption>"
                   "</figure>",
                   page::escape(caption), width_px, height_px);
}

std::string bars_svg(std::span<const Bar> bars, std::string_view unit, std::string_view caption) {
  constexpr int kStep = 26, kHeight = 150, kTop = 24, kBelow = 22, kLeft = 8;
  double largest = 1e-9;
  for (const auto& bar : bars) largest = std::max(largest, bar.value);
  const int width = 2 * kLeft + kStep * static_cast<int>(bars.size());
  auto svg = fmt::format("<figure><svg width='{0}' viewBox='0 0 {0} {1}'>", width,
                         kTop + kHeight + kBelow);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double height = kHeight * bars[i].value / largest;
    const int x = kLeft + kStep * static_cast<int>(i);
    svg += fmt::format(
        "<rect class='{}' x='{}' y='{:.1f}' width='{}' height='{:.1f}'/>"
        "<text x='{}' y='{}' text-anchor='middle' font-size='12'>{}</text>",
        bars[i].is_left_out ? "out" : "in", x + 3, kTop + kHeight - height, kStep - 6, height,
        x + kStep / 2, kTop + kHeight + 16, i + 1);
    if (bars[i].value == largest)
      svg += fmt::format("<text x='{}' y='{}' text-anchor='middle' font-size='12'>{:.2f} {}</text>",
                         std::clamp(x + kStep / 2, 32, std::max(32, width - 32)), kTop - 8, largest,
                         page::escape(unit));
  }
  return svg + fmt::format("</svg><figcaption>{}</figcaption></figure>", page::escape(caption));
}

}  // namespace handcast::calibrate
