// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "services/lab/chart/chart.hpp"
#include "services/lab/chart/ladder.hpp"
#include "services/lab/chart/script.hpp"

namespace handcast::chart {
namespace {

/// Just noticeable delay of the light, without and with the fill (paper, "Just Noticeable
/// Difference").
constexpr double kJndEdges_ms = 3.08, kJndFilled_ms = 6.62;

constexpr int kWidth_px = 1090, kHeight_px = 440;
constexpr double kFrom_ms = 2;  ///< less than the delay of any camera and projector

struct Panel {
  std::vector<Standing> standings;
  std::vector<Point> points;
  std::vector<std::size_t> front;
};

Panel panel_of(const Ladder& ladder, double speed) {
  Panel panel;
  for (const auto& standing : ladder.at(speed)) {
    if (!standing.photon_ms) continue;
    panel.standings.push_back(standing);
    panel.points.push_back({*standing.photon_ms, *standing.p95_mm});
  }
  // "ideal" uses the truth, so that it cannot be built and is not on the front.
  std::vector<Point> buildable = panel.points;
  for (std::size_t i = 0; i < buildable.size(); ++i)
    if (panel.standings[i].method.variant == "ideal") buildable[i] = {1e9, 1e9};
  panel.front = pareto_front(buildable);
  return panel;
}

void draw_bands(Script& script) {
  const auto& area = script.area();
  script.band(0, kJndEdges_ms, kNear);
  script.band(kJndEdges_ms, kJndFilled_ms, kFar);
  const auto note = [&](double at_ms, const char* words) {
    const auto place = script.place_px({at_ms, 1});
    script.text(place.x - 5, area.top + 10, words, {kQuiet, "right", 11});
  };
  note(kJndEdges_ms, "3.08");
  note(kJndFilled_ms, "6.62, filled");
}

/// The Pareto front as a staircase from its first point to its last.
std::vector<Point> stair_of(const Panel& panel) {
  std::vector<Point> stair;
  for (const auto i : panel.front) {
    if (!stair.empty()) stair.push_back({panel.points[i].x, stair.back().y});
    stair.push_back(panel.points[i]);
  }
  return stair;
}

std::string label_of(const Standing& standing) {
  if (!standing.method.detects || !standing.landmarks_ms) return standing.method.label;
  return fmt::format("{}, {:.0f} ms old", standing.method.label, *standing.landmarks_ms);
}

bool is_of_rungs(const Method& method) { return method.freedoms.has_value(); }

void draw(Script& script, const Panel& panel, double speed, const Area& area, const Range& x,
          const Range& y) {
  script.panel(area, x, y);
  script.text(area.left - 34, area.top - 38, name_of_speed(speed), {kInk, "left", 15, true});
  script.y_axis("interior error, 95th percentile, mm");
  script.x_axis("motion to photon, ms");
  draw_bands(script);
  script.series(stair_of(panel), fmt::format("lines lc rgb \"{}\" lw 2 dt (6,4)", kOurs.value));
  std::vector<Label> labels;
  for (std::size_t i = 0; i < panel.points.size(); ++i) {
    const auto& method = panel.standings[i].method;
    const bool ours = method.variant == "handcast";
    script.series({&panel.points[i], 1}, fmt::format("points pt 7 ps {} lc rgb \"{}\"",
                                                     ours                  ? 1.3
                                                     : is_of_rungs(method) ? 0.6
                                                                           : 0.95,
                                                     method.colour.value));
    labels.push_back({panel.points[i],
                      fmt::format("{}  {:.1f}", label_of(panel.standings[i]), panel.points[i].y),
                      is_of_rungs(method) ? kQuiet : kInk, ours});
  }
  label_beside(script, labels);
  script.plot();
}

std::string script_of(const Ladder& ladder, const std::vector<Panel>& panels) {
  std::vector<double> xs{kJndFilled_ms}, ys;
  for (const auto& panel : panels)
    for (const auto& point : panel.points) xs.push_back(point.x + 0.4), ys.push_back(point.y);
  auto x = range_of(xs, false);
  x.low = kFrom_ms;
  const auto y = range_of(ys, true);
  Script script("chart_a", kWidth_px, kHeight_px);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const double left = 44 + 530.0 * static_cast<double>(i);
    draw(script, panels[i], ladder.speeds[i], {left, 62, left + 272, kHeight_px - 52}, x, y);
  }
  return script.finish();
}

NumberTable table_of(const Ladder& ladder, const std::vector<Panel>& panels) {
  NumberTable table{"chart_a",
                    "Means over the motions and seeds of the sweep. The error is that at the "
                    "middle of a frame's light. The motion-to-photon time of the paper has its "
                    "published software time; those of the others have the measured time of a "
                    "frame on one core, which is that of handcast for ideal landmarks, the paper "
                    "at our speed and real detectors. Simulated figures are the same on all "
                    "machines; columns in italics depend on the machine that ran the sweep.",
                    {{"speed", "speed"},
                     {"method", "method"},
                     {"back_end", "back end"},
                     {"motion_to_photon_ms", "motion to photon, ms", 2, ladder.timed_alone},
                     {"interior_mm_p95", "interior p95, mm", 2},
                     {"interior_mm_mean", "mean, mm", 2},
                     {"coverage", "coverage", 3},
                     {"spill", "spill", 3},
                     {"jitter_px", "landmark jitter, px", 2},
                     {"landmarks_age_ms", "landmark age, ms", 1},
                     {"frame_us_p50", "frame, µs p50", 0, true},
                     {"on_front", "on the front"},
                     {"runs", "runs", 0}},
                    {}};
  for (std::size_t k = 0; k < panels.size(); ++k)
    for (std::size_t i = 0; i < panels[k].standings.size(); ++i) {
      const auto& standing = panels[k].standings[i];
      const bool on_front = std::ranges::find(panels[k].front, i) != panels[k].front.end();
      table.rows.push_back({name_of_speed(ladder.speeds[k]), standing.method.label, "cpu",
                            standing.photon_ms, standing.p95_mm, standing.mean_mm,
                            standing.coverage, standing.spill, standing.jitter_px,
                            standing.landmarks_ms, standing.frame_us, on_front ? "yes" : "",
                            static_cast<double>(standing.runs)});
    }
  return table;
}

}  // namespace

Chart chart_a(const Results& results) {
  Chart chart{
      "chart_a",
      "A. Speed against accuracy",
      "Further left is faster, further down is more accurate: the error is the one that 95 "
      "% of the points of the skin do not exceed; a point without light counts as 20 mm. "
      "The dashed line joins the methods that no other method beats in both. What is \"with\" a "
      "detector is handcast. In the shaded bands the delay is not noticed: up to 3.08 ms without "
      "the fill, when the edges of the light are visible, and up to 6.62 ms with it.",
      {},
      {},
      {}};
  const auto ladder = ladder_of(results);
  std::vector<Panel> panels;
  for (const double speed : ladder.speeds) panels.push_back(panel_of(ladder, speed));
  if (std::ranges::all_of(panels, [](const Panel& panel) { return panel.points.empty(); })) {
    chart.lacking =
        "needs drawn runs with the columns motion_to_photon_ms and interior_mm_p95: sweep "
        "config/sweeps/ladder.toml";
    return chart;
  }
  chart.script = script_of(ladder, panels);
  chart.tables.push_back(table_of(ladder, panels));
  return chart;
}

}  // namespace handcast::chart
