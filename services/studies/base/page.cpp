// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/text.hpp"

namespace handcast::study {
namespace {

constexpr std::string_view kHead = R"(<!doctype html>
<html lang="en"><meta charset="utf-8"><title>handcast: TITLE</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
:root { color-scheme: light dark; --ink: light-dark(#1c232b, #dfe3e8); --first: light-dark(#8b97a5, #7d8894); --second: light-dark(#1273c4, #58b0ff); }
body { color: var(--ink); font: 16px/1.55 system-ui, sans-serif; margin: 2.5rem auto; max-width: 900px; padding: 0 1.2rem; }
h1 { font-weight: 500; } h2 { font-size: 1.1rem; margin-top: 2.2rem; }
svg { display: block; width: 100%; height: auto; } svg text { fill: var(--ink); font: 12px system-ui, sans-serif; }
.bar0 { fill: var(--first); } .bar1 { fill: var(--second); } .axis { stroke: var(--ink); stroke-opacity: .18; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; } td, th { padding: .2rem .9rem .2rem 0; text-align: right; } td:first-child, th:first-child { text-align: left; }
figure { margin: 0; } pre { white-space: pre-wrap; } img { max-width: 100%; } small { opacity: .75; }
</style>
<h1>TITLE</h1>
)";

}  // namespace

std::string page_head(std::string_view title) {
  std::string head(kHead);
  for (std::size_t at = 0; (at = head.find("TITLE", at)) != head.npos; at += title.size())
    head.replace(at, 5, title);
  return head;
}

std::string bars_of(const Comparison& comparison, const std::string& unit) {
  constexpr double kWidth = 860, kHeight = 300, kLeft = 40, kBottom = 30, kTop = 30;
  double most = 1;
  for (const auto& values : comparison.values)
    for (const double value : values) most = std::max(most, value);
  const double per_unit = (kHeight - kBottom - kTop) / most, floor = kHeight - kBottom;
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"values by subject and condition\">",
      kWidth, kHeight);
  const double decade = std::pow(10, std::floor(std::log10(most)));
  const double step = decade * (most > 5 * decade ? 1 : most > 2 * decade ? 0.5 : 0.2);
  const int lines = static_cast<int>(most / step);  // 2 to 10
  for (int line = 0; line <= lines; ++line) {
    const double value = line * step;
    svg += fmt::format(
        "<line class=\"axis\" x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>",
        kLeft, kWidth, floor - value * per_unit, kLeft - 6, floor - value * per_unit + 4, value);
  }
  const auto subjects = static_cast<double>(comparison.subjects.size()),
             conditions = static_cast<double>(comparison.conditions.size());
  const double group = (kWidth - kLeft) / subjects, bar = std::min(30.0, 0.7 * group / conditions);
  for (std::size_t s = 0; s < comparison.subjects.size(); ++s) {
    const double middle = kLeft + group * (static_cast<double>(s) + 0.5);
    for (std::size_t c = 0; c < comparison.conditions.size(); ++c) {
      const double height = std::max(0.0, comparison.values[c][s]) * per_unit;
      svg += fmt::format(
          "<rect class=\"bar{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
          "height=\"{:.1f}\"><title>{}, {}: {:.2f} {}</title></rect>",
          c % 2, middle + (static_cast<double>(c) - conditions / 2) * bar, floor - height, bar - 2,
          height, html_of(comparison.subjects[s]), html_of(comparison.conditions[c]),
          comparison.values[c][s], unit);
    }
    if (subjects <= 40)
      svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", middle,
                         kHeight - 10, html_of(comparison.subjects[s]));
  }
  for (std::size_t c = 0; c < comparison.conditions.size(); ++c)
    svg += fmt::format(
        "<rect class=\"bar{}\" x=\"{}\" y=\"6\" width=\"12\" height=\"12\"/>"
        "<text x=\"{}\" y=\"16\">{}</text>",
        c % 2, kLeft + 150 * static_cast<double>(c), kLeft + 18 + 150 * static_cast<double>(c),
        html_of(comparison.conditions[c]));
  return svg + fmt::format("<text x=\"0\" y=\"16\">{}</text></svg>", unit);
}

}  // namespace handcast::study
