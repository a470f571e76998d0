// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/pieces.hpp"

#include <fmt/format.h>

#include "services/evaluation/page/document.hpp"
#include "services/evaluation/page/html.hpp"

namespace handcast::calibrate {
namespace {

constexpr const char* kStyle =
    "svg{border:1px solid currentColor;max-width:100%;height:auto}"
    "svg circle{fill:currentColor}";

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

std::string report_html(const std::string& rig, const calib::Calibration& draft,
                        const std::string& pieces) {
  const auto fact_of = [](std::string_view name, const std::string& made) {
    return page::fact(name, made.empty() ? "not measured yet" : made);
  };
  return page::to_html({.title = "Calibration of " + rig,
                        .style = kStyle,
                        .facts = fact_of("lens", draft.made.lens) +
                                 fact_of("screen", draft.made.screen) +
                                 fact_of("tracker", draft.made.tracker),
                        .header = {},
                        .body = pieces});
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
