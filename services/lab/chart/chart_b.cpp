// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "services/lab/chart/chart.hpp"
#include "services/lab/chart/script.hpp"
#include "services/lab/chart/stress.hpp"

namespace handcast::chart {
namespace {

constexpr int kColumns = 3;
constexpr double kPanelWidth_px = 326, kPanelHeight_px = 280;
constexpr double kBreakdownLabel_px = 27;  ///< width

struct Panel {
  Stress stress;
  std::vector<StressLine> lines;
};

std::vector<Panel> panels_of(const Results& results) {
  std::vector<Panel> panels;
  for (const auto& stress : stresses())
    if (auto lines = lines_of(results, stress); !lines.empty())
      panels.push_back({stress, std::move(lines)});
  return panels;
}

std::string short_label(const Method& method) {
  return method.variant == "paper" ? "paper" : method.label;
}

void mark_breakdown(Script& script, const StressLine& line) {
  if (!line.breakdown) return;
  script.series({&*line.breakdown, 1},
                fmt::format("points pt 6 ps 1.2 lw 2 lc rgb \"{}\"", line.method.colour.value));
  const auto place = script.place_px(*line.breakdown);
  const auto number = fmt::format("{:.3g}", line.breakdown->x);
  if (line.method.variant == "handcast")
    script.text(place.x + 9, place.y + 11, number, {line.method.colour, "left", 11});
  else  // above the line on the left, but inside the panel
    script.text(std::max(place.x - 9, script.area().left + kBreakdownLabel_px), place.y - 15,
                number, {line.method.colour, "right", 11});
}

/// Panels with the same metric have the same y axis.
Range harm_range(const std::vector<Panel>& panels, const Panel& like) {
  std::vector<double> ys;
  for (const auto& panel : panels)
    for (const auto& line : panel.lines)
      for (const auto& point : line.points)
        if (panel.stress.harm_title == like.stress.harm_title) ys.push_back(point.y);
  return range_of(ys, std::ranges::min(ys) > 0);
}

Range stress_range(const Panel& panel) {
  std::vector<double> xs;
  for (const auto& line : panel.lines)
    for (const auto& point : line.points) xs.push_back(point.x);
  return range_of(xs, false);
}

void draw(Script& script, const Panel& panel, const Range& y, double left_px, double top_px) {
  script.panel(
      {left_px + 40, top_px + 58, left_px + kPanelWidth_px - 98, top_px + kPanelHeight_px - 46},
      stress_range(panel), y);
  script.tics("x", nice_tics(stress_range(panel), 4));
  script.text(left_px + 6, top_px + 20, panel.stress.title, {kInk, "left", 14, true});
  script.y_axis(panel.stress.harm_title);
  script.x_axis(panel.stress.unit);
  std::vector<Label> labels;
  for (const auto& line : panel.lines) {
    const bool ours = line.method.variant == "handcast";
    script.series(line.points, fmt::format("linespoints lc rgb \"{}\" lw {} pt 7 ps 0.45",
                                           line.method.colour.value, ours ? 2.5 : 1.8));
    mark_breakdown(script, line);
    labels.push_back({line.points.back(), short_label(line.method), line.method.colour, ours});
  }
  label_beside(script, labels, 15);
  script.plot();
}

std::string script_of(const std::vector<Panel>& panels) {
  const int rows = (static_cast<int>(panels.size()) + kColumns - 1) / kColumns;
  Script script("chart_b", static_cast<int>(kColumns * kPanelWidth_px),
                static_cast<int>(rows * kPanelHeight_px));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const std::size_t column = i % kColumns, row = i / kColumns;
    draw(script, panels[i], harm_range(panels, panels[i]),
         kPanelWidth_px * static_cast<double>(column), kPanelHeight_px * static_cast<double>(row));
  }
  return script.finish();
}

std::vector<Column> with_methods(std::vector<Column> columns, const std::vector<Method>& methods,
                                 int digits) {
  for (const auto& method : methods)
    columns.push_back({method.variant, short_label(method), digits});
  return columns;
}

std::vector<Method> methods_of(const std::vector<Panel>& panels) {
  std::vector<Method> methods;
  for (const auto& panel : panels)
    for (const auto& line : panel.lines)
      if (std::ranges::find(methods, line.method.variant, &Method::variant) == methods.end())
        methods.push_back(line.method);
  return methods;
}

const StressLine* line_of(const Panel& panel, const Method& method) {
  const auto found = std::ranges::find_if(
      panel.lines, [&](const StressLine& line) { return line.method.variant == method.variant; });
  return found == panel.lines.end() ? nullptr : &*found;
}

NumberTable breakdowns_of(const std::vector<Panel>& panels, const std::vector<Method>& methods) {
  NumberTable table{
      "chart_b_breakdown",
      "The stress at which the harm is twice that of the mildest stress of the sweep. A dash: not "
      "reached within the sweep.",
      with_methods({{"stress", "breaks down at"}, {"unit", "unit"}, {"up_to", "swept up to", 1}},
                   methods, 1),
      {}};
  for (const auto& panel : panels) {
    double most = 0;
    for (const auto& line : panel.lines) most = std::max(most, line.points.back().x);
    std::vector<Cell> row{std::string(panel.stress.title), std::string(panel.stress.unit), most};
    for (const auto& method : methods) {
      const auto* line = line_of(panel, method);
      row.push_back(line && line->breakdown ? std::optional(line->breakdown->x) : std::nullopt);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

const Point* point_at(const StressLine* line, double level) {
  if (!line) return nullptr;
  const auto found = std::ranges::find(line->levels, level);
  return found == line->levels.end()
             ? nullptr
             : &line->points[static_cast<std::size_t>(found - line->levels.begin())];
}

/// All levels at which any method has a point, and the x of the first such method.
std::map<double, double> levels_of(const Panel& panel) {
  std::map<double, double> levels;
  for (const auto& line : panel.lines)
    for (std::size_t i = 0; i < line.levels.size(); ++i)
      levels.emplace(line.levels[i], line.points[i].x);
  return levels;
}

NumberTable numbers_of(const std::vector<Panel>& panels, const std::vector<Method>& methods) {
  NumberTable table{
      "chart_b",
      "Means over motions and seeds. Simulated: the same on all machines.",
      with_methods(
          {{"stress", "stress"}, {"level", "level", 2}, {"unit", "unit"}, {"harm", "harm"}},
          methods, 2),
      {}};
  for (const auto& panel : panels)
    for (const auto& [level, stress] : levels_of(panel)) {
      std::vector<Cell> row{std::string(panel.stress.title), stress, std::string(panel.stress.unit),
                            std::string(panel.stress.harm_title)};
      for (const auto& method : methods) {
        const auto* point = point_at(line_of(panel, method), level);
        row.push_back(point ? std::optional(point->y) : std::nullopt);
      }
      table.rows.push_back(std::move(row));
    }
  return table;
}

}  // namespace

Chart chart_b(const Results& results) {
  Chart chart{"chart_b",
              "B. Where methods fail",
              "One setting at a time is made worse; the others have their defaults. Points without "
              "light count as 20 mm. The open circle is the breakdown point, at which the harm is "
              "twice that of the mildest stress.",
              {},
              {},
              {}};
  const auto panels = panels_of(results);
  if (panels.empty()) {
    chart.lacking =
        "needs runs in which a single setting is made worse: sweep config/sweeps/stress.toml";
    return chart;
  }
  const auto methods = methods_of(panels);
  chart.script = script_of(panels);
  chart.tables = {breakdowns_of(panels, methods), numbers_of(panels, methods)};
  return chart;
}

}  // namespace handcast::chart
