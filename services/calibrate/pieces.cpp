// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/pieces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/settings/choice.hpp"
#include "services/evaluation/page/document.hpp"
#include "services/evaluation/page/html.hpp"

namespace handcast::calibrate {
namespace {

constexpr const char* kStyle =
    "svg{border:1px solid currentColor;max-width:100%;height:auto}"
    "svg circle,svg rect,svg text{fill:currentColor}";

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

std::string piece_html(std::string_view step, const Outcome& outcome) {
  auto html =
      fmt::format("<section><h2>{}</h2><p>{}</p>", page::escape(step), page::escape(outcome.made));
  if (!outcome.findings.empty()) {
    html += "<ul>";
    for (const auto& finding : outcome.findings)
      html += fmt::format("<li>{}</li>", page::escape(finding));
    html += "</ul>";
  }
  return html + outcome.pictures + "</section>\n";
}

std::string report_html(const std::string& rig, std::span<const Step> steps,
                        const calib::Calibration& draft, const std::string& pieces) {
  std::string facts;
  const auto add = [&](Step step, const std::string& made) {
    if (!made.empty() || std::ranges::count(steps, step) > 0)
      facts += page::fact(config::word_of(step), made.empty() ? "not measured yet" : made);
  };
  add(Step::lens, draft.made.lens);
  add(Step::lens2, draft.made.lens2);
  add(Step::pair, draft.made.pair);
  add(Step::screen, draft.made.screen);
  add(Step::tracker, draft.made.tracker);
  return page::to_html({.title = "Calibration of " + rig,
                        .style = kStyle,
                        .facts = facts,
                        .header = {},
                        .body = pieces});
}

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
  auto svg =
      fmt::format("<figure><svg width='{0}' viewBox='-0.5 -0.5 {0} {1}'>", width_px, height_px);
  for (const auto& px : dots_px)
    svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='1.5'/>", px.x, px.y);
  return svg + fmt::format("</svg><figcaption>{}</figcaption></figure>", page::escape(caption));
}

}  // namespace handcast::calibrate
