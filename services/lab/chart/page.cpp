// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/page.hpp"

#include <fmt/format.h>

#include "services/lab/chart/svg.hpp"
#include "services/tools/page/document.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::chart {
namespace {

constexpr const char* kHeader =
    R"html(<p class="quiet">Errors are simulated on the digital twin in virtual time and are the same on all machines. Frame times, and the figures that depend on
them (columns in italics), are those of the machine that ran the sweeps.</p>
)html";

/// The colours of palette.hpp for the light and the dark colour scheme.
constexpr const char* kStyle = R"css(
:root { --near: #e3efe9; --far: #f3f1e7; --fast: #3b5fa0; }
@media (prefers-color-scheme: dark) { :root { --near: #1f3a33; --far: #2a2a22; --fast: #86a8e6; } }
main { max-width: 1040px; }
figure { margin: 1rem 0; padding: 1rem; background: var(--panel); border: 1px solid var(--line); border-radius: 6px; overflow-x: auto; }
figure svg { display: block; width: 100%; min-width: 640px; height: auto; }
figure svg text, figure svg tspan { font-family: system-ui, -apple-system, "Segoe UI", "Noto Sans", sans-serif; }
.machine, .machine-note { font-style: italic; }
details { margin: .6rem 0 1rem; }
summary { cursor: pointer; font-weight: 600; font-size: .92rem; }
table { font-size: .88rem; }
th, td { padding: .25rem .45rem; }
thead th { white-space: normal; vertical-align: bottom; }
)css";

std::string source_fact(const Source& source) {
  auto words = fmt::format("{} of {} runs", source.scored, source.planned);
  if (source.failed > 0) words += fmt::format(", {} failed", source.failed);
  return page::fact("sweep " + source.plan, words);
}

std::string section(const Chart& chart, const std::string& drawing) {
  auto html = fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n<p>{}</p>\n", chart.name,
                          page::escape(chart.title), page::escape(chart.reading));
  if (drawing.empty())
    return html + page::missing(fmt::format("Not drawn: the chart {}.", chart.lacking)) +
           "</section>\n";
  html += fmt::format("<figure role=\"img\" aria-label=\"{}\">\n{}</figure>\n",
                      page::escape(chart.title), as_part_of_page(drawing, chart.name));
  for (const auto& table : chart.tables) html += to_html(table);
  return html + "</section>\n";
}

}  // namespace

std::string make_page(const Results& results, const std::vector<Chart>& charts,
                      const std::vector<std::string>& drawings, const Imprint& imprint) {
  std::string facts, sections;
  for (const auto& source : results.sources) facts += source_fact(source);
  facts += page::fact("drawn on", imprint.machine) + page::fact("at", imprint.date);
  for (std::size_t i = 0; i < charts.size(); ++i) sections += section(charts[i], drawings[i]);
  return page::to_html({imprint.title, kStyle, facts, kHeader, sections});
}

}  // namespace handcast::chart
