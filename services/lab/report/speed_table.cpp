// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "services/lab/report/tables.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::report {
namespace {

using Place = nlohmann::json::json_pointer;

std::optional<double> in_bin(const Run& run, const std::string& bin, const char* place) {
  return run.metrics.number(Place("/bins") / bin / Place(place));
}

/// The bins in which any run scored a frame. Their names ("0-0.1" … ">1.0") sort by speed.
std::set<std::string> bins_of(const Inputs& inputs) {
  std::set<std::string> bins;
  for (const auto& run : inputs.runs) {
    if (!run.metrics.content || !run.metrics.content->contains("bins")) continue;
    for (const auto& bin : run.metrics.content->at("bins").items())
      if (in_bin(run, bin.key(), "/frames").value_or(0) > 0) bins.insert(bin.key());
  }
  return bins;
}

/// A bar chart of the 95th percentile: a group of three bars per bin.
std::string chart(const Inputs& inputs, const std::set<std::string>& bins) {
  constexpr double kWidth = 840, kHeight = 170, kBar = 40, kGap = 4, kTop = 18;
  double highest = 0;
  for (const auto& bin : bins)
    for (const auto& run : inputs.runs)
      highest = std::max(highest, in_bin(run, bin, "/interior_mm/p95").value_or(0));
  if (highest <= 0) return "";
  const double group = kWidth / static_cast<double>(bins.size());
  const double bars = kBar * static_cast<double>(inputs.runs.size()) +
                      kGap * static_cast<double>(inputs.runs.size() - 1);
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"Interior error, p95 in mm, by "
      "speed\" style=\"max-width:{0}px\">\n",
      kWidth, kTop + kHeight + 26);
  double left = (group - bars) / 2;
  for (const auto& bin : bins) {
    double x = left;
    for (const auto& run : inputs.runs) {
      const auto value = in_bin(run, bin, "/interior_mm/p95");
      const double height = kHeight * value.value_or(0) / highest;
      svg += fmt::format(
          "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\" rx=\"2\"/>",
          page::escape(run.name), x, kTop + kHeight - height, kBar, height);
      if (value)
        svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{:.1f}</text>", x + kBar / 2,
                           kTop + kHeight - height - 4, *value);
      x += kBar + kGap;
    }
    svg += fmt::format("<text class=\"axis\" x=\"{:.1f}\" y=\"{}\">{} m/s</text>\n",
                       left + bars / 2, kTop + kHeight + 17, page::escape(bin));
    left += group;
  }
  return svg + fmt::format("<line x1=\"0\" x2=\"{0}\" y1=\"{1}\" y2=\"{1}\"/></svg>\n", kWidth,
                           kTop + kHeight);
}

std::string legend(const Inputs& inputs) {
  std::string keys;
  for (const auto& run : inputs.runs)
    keys += fmt::format("<span class=\"key {0}\">{0}</span> ", page::escape(run.name));
  return "<p class=\"legend\">" + keys + "</p>\n";
}

std::string rows(const Inputs& inputs, const std::set<std::string>& bins) {
  std::string text;
  for (const auto& bin : bins) {
    text += fmt::format("<tr><th scope=\"row\">{}</th>", page::escape(bin));
    for (const auto& run : inputs.runs)
      text += fmt::format("<td>{}</td>", page::figure(in_bin(run, bin, "/interior_mm/mean"), 2));
    for (const auto& run : inputs.runs)
      text += fmt::format("<td>{}</td>", page::figure(in_bin(run, bin, "/interior_mm/p95"), 2));
    for (const auto& run : inputs.runs)
      text += fmt::format("<td>{}</td>", page::figure(in_bin(run, bin, "/coverage"), 3));
    text += "</tr>\n";
  }
  return text;
}

}  // namespace

std::string speed_table(const Inputs& inputs) {
  const auto bins = bins_of(inputs);
  if (bins.empty())
    return page::missing("None of baseline.json, paper.json and twin.json has figures by speed.");
  std::string names;
  for (int column = 0; column < 3; ++column)
    for (const auto& run : inputs.runs)
      names += fmt::format("<th scope=\"col\">{}</th>", page::escape(run.name));
  return legend(inputs) + "<div class=\"wide\">" + chart(inputs, bins) + "</div>\n" +
         "<div class=\"wide\"><table>\n<thead><tr><th></th><th colspan=\"3\">mean, mm</th><th "
         "colspan=\"3\">p95, mm</th>"
         "<th colspan=\"3\">coverage</th></tr>\n<tr><th>m/s</th>" +
         names + "</tr></thead>\n<tbody>\n" + rows(inputs, bins) + "</tbody></table></div>\n";
}

}  // namespace handcast::report
