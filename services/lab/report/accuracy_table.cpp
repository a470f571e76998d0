// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "services/lab/report/tables.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::report {
namespace {

enum class Better { lower, higher, nearer_zero };

struct Metric {
  const char* name;
  const char* unit;
  const char* pointer;
  double factor;
  int digits;
  Better better;
  const char* reading;
};

constexpr Metric kMetrics[] = {
    {"Interior error, mean", "mm", "/interior_mm/mean", 1, 2, Better::lower,
     "Distance on the skin between a point and the point whose picture falls on it, over all "
     "visible points; 20 mm where there is no light."},
    {"Interior error, p95", "mm", "/interior_mm/p95", 1, 2, Better::lower,
     "95 % of the points have a smaller error."},
    {"Interior error, p99", "mm", "/interior_mm/p99", 1, 2, Better::lower,
     "99 % of the points have a smaller error. The larger ones are noticed in fast motion."},
    {"Interior error, p95", "projector px", "/interior_px/p95", 1, 2, Better::lower,
     "The 95th percentile in pixels of the projector."},
    {"Missing", "%", "/missing", 100, 2, Better::lower,
     "Share of the points of the skin that have no light of their hand."},
    {"Coverage", "%", "/coverage", 100, 2, Better::higher,
     "Share of the hand that is lit. Unlit parts appear as dark rims."},
    {"Spill", "%", "/spill", 100, 2, Better::lower,
     "Area of the light beside the hand, as a share of the hand."},
    {"Overlap (IoU)", "", "/iou", 1, 4, Better::higher,
     "Area of the lit hand divided by the area of hand and light together; 1 is a perfect "
     "outline."},
    {"Seam", "px", "/seam_px", 1, 1, Better::lower,
     "Length of the edge of the light that runs across the hand instead of around it."},
    {"Jitter", "px RMS", "/jitter_px", 1, 3, Better::lower,
     "Trembling of the light on a slow hand in 1-30 Hz, where people see it. Measured if more than "
     "60 frames a second are scored."},
    {"Fold-overs", "", "/foldovers", 1, 0, Better::lower,
     "Triangles of the drawn hand that the correction has turned over. There should be none."},
    {"Equivalent latency", "ms", "/equivalent_latency_ms", 1, 2, Better::nearer_zero,
     "The delay that explains the error best. It means little for a hand that hardly moves. People "
     "notice 3.1 ms without and 6.6 ms with the fill."},
    {"Residual", "px RMS", "/residual_px", 1, 2, Better::lower,
     "The error that no delay explains."},
    {"Frame, p50", "µs", "/frame_us/p50", 1, 0, Better::lower,
     "Median software time of one projector frame on the machine that ran the simulation."},
    {"Frame, p99", "µs", "/frame_us/p99", 1, 0, Better::lower,
     "99 % of the frames take less time."},
};

std::optional<double> best_of(const Inputs& inputs, const Metric& metric) {
  std::vector<double> values;
  for (const auto& run : inputs.runs)
    if (const auto value = run.metrics.number(metric.pointer)) values.push_back(*value);
  if (values.size() < 2) return std::nullopt;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (*least == *most) return std::nullopt;
  if (metric.better == Better::nearer_zero)
    return *std::min_element(values.begin(), values.end(),
                             [](double a, double b) { return std::abs(a) < std::abs(b); });
  return metric.better == Better::lower ? *least : *most;
}

std::string metric_rows(const Inputs& inputs, const Metric& metric) {
  const auto best = best_of(inputs, metric);
  std::string row =
      fmt::format("<tr class=\"figures\"><th scope=\"row\">{} <span class=\"unit\">{}</span></th>",
                  metric.name, metric.unit);
  for (const auto& run : inputs.runs) {
    const auto value = run.metrics.number(metric.pointer);
    const bool is_best = best && value && *value == *best;
    const auto shown = value ? std::optional(*value * metric.factor) : std::nullopt;
    row += fmt::format("<td{}>{}</td>", is_best ? " class=\"best\"" : "",
                       page::figure(shown, metric.digits));
  }
  return row + fmt::format("</tr>\n<tr class=\"reading\"><td colspan=\"4\">{}</td></tr>\n",
                           metric.reading);
}

/// A value of the detector of a run; null if the run has none.
nlohmann::json of_detector(const Run& run, const char* key) {
  const nlohmann::json::json_pointer place("/detector");
  if (!run.metrics.content || !run.metrics.content->contains(place)) return {};
  const auto& detector = run.metrics.content->at(place);
  return detector.is_object() ? detector.value(key, nlohmann::json()) : nlohmann::json();
}

/// What found the landmarks of a run, and how old they were.
std::string detector_of(const Run& run) {
  const auto backend = of_detector(run, "backend"), used = of_detector(run, "used");
  if (used.is_boolean() && !used.get<bool>()) return "not used";
  if (!backend.is_string()) return "–";
  return fmt::format("{}, {} ms old", page::escape(backend.get<std::string>()),
                     page::figure(run.metrics.number("/detector/age_ms"), 1));
}

std::string detector_row(const Inputs& inputs) {
  std::string row = "<tr class=\"figures\"><th scope=\"row\">Landmarks</th>";
  for (const auto& run : inputs.runs) row += fmt::format("<td>{}</td>", detector_of(run));
  return row +
         "</tr>\n<tr class=\"reading\"><td colspan=\"4\">The detector that has run, on the images "
         "of the twin. twin: no detector but the twin's model of one.</td></tr>\n";
}

/// A sentence for each run that had another detector than its rig names.
std::string replaced_detectors(const Inputs& inputs) {
  std::string sentences;
  for (const auto& run : inputs.runs)
    if (const auto why = of_detector(run, "why"); why.is_string())
      sentences += page::missing(fmt::format("{}: {}.", run.name, why.get<std::string>()));
  return sentences;
}

/// A paragraph that separates the effect of the method from that of the software time, in which the
/// rigs differ too.
std::string equal_legs(const Inputs& inputs) {
  const Source& equal = inputs.equal_legs;
  const auto p95 = equal.number("/interior_mm/p95"), coverage = equal.number("/coverage"),
             spill = equal.number("/spill");
  if (!p95 || !coverage || !spill) return "";
  return fmt::format(
      "<p>Each rig is simulated with the time that its software takes. With the {} ms of the "
      "paper, handcast has a p95 of <b>{} mm</b>, a coverage of <b>{} %</b> and a spill of <b>{} "
      "%</b>: the remaining difference is that of the method.</p>\n",
      page::figure(equal.number("/software_ms"), 2), page::figure(p95, 2),
      page::figure(*coverage * 100, 2), page::figure(*spill * 100, 2));
}

}  // namespace

std::string headline(const Inputs& inputs) {
  std::string cards;
  for (const auto& run : inputs.runs) {
    const auto percent = run.metrics.number("/coverage");
    cards += fmt::format(
        "<div class=\"card {0}\"><h3>{0}</h3><p class=\"big\">{1}<span class=\"unit\"> "
        "mm</span></p><p>{2} mm mean, {3} % of the hand lit</p><p class=\"quiet\">{4}</p></div>\n",
        page::escape(run.name), page::figure(run.metrics.number("/interior_mm/p95"), 2),
        page::figure(run.metrics.number("/interior_mm/mean"), 2),
        page::figure(percent ? std::optional(*percent * 100) : std::nullopt, 1),
        page::escape(run.sentence));
  }
  return "<div class=\"cards\">\n" + cards +
         "</div>\n<p class=\"quiet\">Large figure: how far light is from its place on the skin, in "
         "all but the worst 5 % of the points. A point without light counts as 20 mm.</p>\n";
}

std::string accuracy_table(const Inputs& inputs) {
  std::string table = "<div class=\"wide\"><table class=\"accuracy\">\n<thead><tr><th></th>";
  for (const auto& run : inputs.runs)
    table += fmt::format("<th scope=\"col\" class=\"{0}\">{0}</th>", page::escape(run.name));
  table += "</tr></thead>\n<tbody>\n" + detector_row(inputs);
  for (const auto& metric : kMetrics) table += metric_rows(inputs, metric);
  table += "</tbody></table></div>\n";
  table += equal_legs(inputs) + replaced_detectors(inputs);
  for (const auto& run : inputs.runs)
    if (!run.metrics.content)
      table += page::missing(
          fmt::format("There are no figures for {}: {}.", run.name, run.metrics.problem));
  return table;
}

}  // namespace handcast::report
