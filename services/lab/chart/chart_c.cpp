// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "services/lab/chart/chart.hpp"
#include "services/lab/chart/ladder.hpp"
#include "services/lab/chart/script.hpp"

namespace handcast::chart {
namespace {

constexpr int kWidth_px = 980, kHeight_px = 400;

/// The rungs at one speed, in their order, and the gate that chooses among them.
struct Series {
  double speed = 1;
  Colour colour;
  std::vector<Standing> rungs;
  std::optional<Standing> gate;
};

std::vector<Series> series_of(const Ladder& ladder) {
  std::vector<Series> all;
  for (const double speed : ladder.speeds) {
    Series series{speed, all.empty() ? kOurs : kFast, {}, {}};
    const auto standings = ladder.at(speed);
    for (const auto& rung : rungs())
      for (const auto& standing : standings)
        if (standing.method.variant == rung.variant) series.rungs.push_back(standing);
    for (const auto& standing : standings)
      if (standing.method.variant == "handcast") series.gate = standing;
    if (!series.rungs.empty()) all.push_back(series);
  }
  return all;
}

double place_of(const Standing& standing) {
  const auto all = rungs();
  const auto found = std::ranges::find(all, standing.method.variant, &Method::variant);
  return static_cast<double>(found - all.begin());
}

std::string line_style(const Colour& colour) {
  return fmt::format("linespoints lc rgb \"{}\" lw 2 pt 7 ps 0.7", colour.value);
}

/// Draws the error over the rungs. The error of the gate is a dashed horizontal line.
void draw_freedoms(Script& script, const std::vector<Series>& all, const Range& y) {
  const Range x{-0.4, static_cast<double>(rungs().size()) - 0.6};
  script.panel({44, 62, 470, kHeight_px - 62}, x, y);
  script.text(10, 24, "by degrees of freedom", {kInk, "left", 15, true});
  script.y_axis("interior error, 95th percentile, mm");
  std::string tics;
  for (std::size_t i = 0; i < rungs().size(); ++i)
    tics += fmt::format("{}\"\" {}", i == 0 ? "" : ", ", i);
  script.line("set xtics ({})", tics);
  for (std::size_t i = 0; i < rungs().size(); ++i) {
    const double at_px = script.place_px({static_cast<double>(i), y.low}).x;
    script.text(at_px, script.area().bottom + 16, fmt::format("{}", *rungs()[i].freedoms),
                {kInk, "center", 12});
    script.text(at_px, script.area().bottom + 33, rungs()[i].label, {kQuiet, "center", 11});
  }
  script.text((script.area().left + script.area().right) / 2, script.area().bottom + 52,
              "degrees of freedom per hand", {kQuiet, "center", 12});
  std::vector<Label> labels;
  for (const auto& series : all) {
    std::vector<Point> points;
    for (const auto& standing : series.rungs)
      points.push_back({place_of(standing), *standing.p95_mm});
    script.series(points, line_style(series.colour));
    labels.push_back({points.back(), name_of_speed(series.speed), series.colour});
    if (!series.gate) continue;
    const std::vector<Point> across{{x.low, *series.gate->p95_mm}, {x.high, *series.gate->p95_mm}};
    script.series(across, fmt::format("lines lc rgb \"{}\" lw 1.5 dt (3,3)", series.colour.value));
    labels.push_back({across.back(), "handcast, gated", series.colour, true});
  }
  label_beside(script, labels);
  script.plot();
}

Range time_range(const std::vector<Series>& all) {
  std::vector<double> times_us;
  for (const auto& series : all)
    for (const auto& standing : series.rungs)
      if (standing.frame_us) times_us.push_back(*standing.frame_us);
  if (times_us.empty()) return {};
  const auto [least, most] = std::ranges::minmax(times_us);
  return {0.93 * least, 1.05 * most, false};
}

/// Draws the error over the time of a frame. The gate is the large point. Only the rungs of the
/// last series have labels: its points are the furthest apart.
void draw_times(Script& script, const std::vector<Series>& all, const Range& y) {
  const auto x = time_range(all);
  if (x.low <= 0) return;
  script.panel({656, 62, 866, kHeight_px - 62}, x, y);
  script.text(622, 24, "by time", {kInk, "left", 15, true});
  script.y_axis("interior error, 95th percentile, mm");
  script.tics("x", nice_tics(x, 3));
  script.x_axis("median frame time on one core, µs");
  std::vector<Label> labels;
  for (const auto& series : all) {
    std::vector<Point> points;
    for (const auto& standing : series.rungs) {
      if (!standing.frame_us) continue;
      points.push_back({*standing.frame_us, *standing.p95_mm});
      if (&series == &all.back())
        labels.push_back({points.back(), standing.method.label, series.colour});
    }
    script.series(points, line_style(series.colour));
    if (!series.gate || !series.gate->frame_us) continue;
    const Point gate{*series.gate->frame_us, *series.gate->p95_mm};
    script.series({&gate, 1}, fmt::format("points lc rgb \"{}\" pt 7 ps 1.3", series.colour.value));
    labels.push_back({gate, "handcast", series.colour, true});
  }
  label_beside(script, labels, 15);
  script.plot();
}

NumberTable table_of(const std::vector<Series>& all, bool timed_alone) {
  NumberTable table{
      "chart_c",
      std::string("Errors are simulated and the same on all machines. Columns in italics are times "
                  "of the machine that ran the sweep, ") +
          (timed_alone ? "measured with one run at a time."
                       : "measured with several runs at a time; sweep config/sweeps/times.toml "
                         "with -j 1 for better ones."),
      {{"speed", "speed"},
       {"rung", "rung"},
       {"degrees_of_freedom", "degrees of freedom", 0},
       {"interior_mm_mean", "interior mean, mm", 2},
       {"interior_mm_p95", "p95, mm", 2},
       {"jitter_px", "jitter, px", 2},
       {"frame_us_p50", "frame, µs p50", 0, true}},
      {}};
  const auto add = [&](const Standing& standing) {
    const auto freedoms = standing.method.freedoms;
    table.rows.push_back(
        {name_of_speed(standing.speed), standing.method.label,
         freedoms ? Cell(static_cast<double>(*freedoms)) : Cell("chosen per frame"),
         standing.mean_mm, standing.p95_mm, standing.jitter_px, standing.frame_us});
  };
  for (const auto& series : all) {
    std::ranges::for_each(series.rungs, add);
    if (series.gate) add(*series.gate);
  }
  return table;
}

}  // namespace

Chart chart_c(const Results& results) {
  Chart chart{"chart_c",
              "C. No more than needed",
              "Each rung of the ladder, used for the whole run, cheapest first: the gain and the "
              "cost of more degrees of freedom. handcast uses the cheapest rung that is good "
              "enough in each frame.",
              {},
              {},
              {}};
  const auto ladder = ladder_of(results);
  const auto all = series_of(ladder);
  if (all.empty()) {
    chart.lacking =
        "needs runs with the rungs hold, predict, shift, similarity, fingers, landmarks and "
        "register as variants: sweep config/sweeps/ladder.toml";
    return chart;
  }
  std::vector<double> errors_mm;
  for (const auto& series : all)
    for (const auto& standing : series.rungs) errors_mm.push_back(*standing.p95_mm);
  for (const auto& series : all)
    if (series.gate) errors_mm.push_back(*series.gate->p95_mm);
  Script script("chart_c", kWidth_px, kHeight_px);
  const auto y = range_of(errors_mm, true);
  draw_freedoms(script, all, y);
  draw_times(script, all, y);
  chart.script = script.finish();
  chart.tables.push_back(table_of(all, ladder.timed_alone));
  return chart;
}

}  // namespace handcast::chart
