// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "services/tools/preview/layout/panels.hpp"

namespace handcast::preview {
namespace {

using theme::kInset_px;

constexpr std::size_t kFewest = 16;  ///< fewer values than that do not fill a graph

/// Points of a graph from the left edge to the right one; `top`: the value at the upper edge.
std::vector<glm::vec2> points_of(const Box& box, std::span<const float> values, double top) {
  std::vector<glm::vec2> points;
  const double step = box.width / static_cast<double>(std::max(values.size(), kFewest) - 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double back = static_cast<double>(values.size() - 1 - i) * step;
    if (!std::isfinite(values[i])) continue;
    const double share = std::clamp(values[i] / std::max(top, 1e-9), 0.0, 1.0);
    points.emplace_back(box.right() - back, box.bottom() - share * box.height);
  }
  return points;
}

void draw_area(Canvas& canvas, const Box& box, std::vector<glm::vec2> points, Colour colour) {
  if (points.size() < 2) return;
  canvas.stroke(points, colour, 1.6);
  points.emplace_back(points.back().x, box.bottom());
  points.emplace_back(points.front().x, box.bottom());
  canvas.fill(points, colour.with_alpha(0.13f));
}

float largest_of(std::span<const float> values) {
  float largest = 0;
  for (const auto value : values)
    if (std::isfinite(value)) largest = std::max(largest, value);
  return largest;
}

void base_line(Canvas& canvas, const Box& box) {
  const std::array<Line, 1> line{Line{{box.x, box.bottom()}, {box.right(), box.bottom()}}};
  canvas.stroke(line, theme::kLine, 1);
}

std::string in_hz(double hz) { return fmt::format("{:.{}f}", hz, hz < 9.95 ? 1 : 0); }

void draw_rate(Canvas& canvas, const Box& box, const RateGauge& rate) {
  const bool known = !rate.held_hz.empty();
  const double held = known ? rate.held_hz.back() : 0;
  canvas.text({box.x, box.y + 12}, rate.stream, theme::kText, theme::kQuiet);
  const auto number = known ? in_hz(held) : "–";
  canvas.text({box.x, box.y + 36}, number, theme::kNumber, theme::kInk);
  const double right = box.x + canvas.width_of(number, theme::kNumber);
  canvas.text({right + 6, box.y + 36},
              rate.wanted_hz ? fmt::format("of {} Hz", in_hz(*rate.wanted_hz)) : "Hz",
              theme::kSmall, theme::kQuiet);
  const Box graph{box.x, box.y + 48, box.width, box.height - 48};
  const double top = 1.15 * std::max<double>(rate.wanted_hz.value_or(0), largest_of(rate.held_hz));
  base_line(canvas, graph);
  if (rate.wanted_hz && top > 0) {
    const double y = graph.bottom() - *rate.wanted_hz / top * graph.height;
    canvas.dash({{graph.x, y}, {graph.right(), y}}, theme::kWanted, 1);
  }
  draw_area(canvas, graph, points_of(graph, rate.held_hz, top), theme::kRate);
}

/// The smallest of 5, 10, 20, 50, … that is not below the value.
double rounded_up(double value) {
  double top = 5;
  for (const double factor : {2.0, 2.0, 2.5, 2.0, 2.0, 2.5, 2.0, 2.0, 2.5})
    if (top < value) top *= factor;
  return top;
}

std::string in_time(double us) {
  if (us < 999.5) return fmt::format("{:.{}f} µs", us, us < 9.95 ? 1 : 0);
  return fmt::format("{:.{}f} ms", us * 1e-3, us < 9.95e3 ? 1 : 0);
}

/// Position on a logarithmic scale from 1 µs to 100 ms, 0..1.
double logarithmic(double us) { return std::clamp(std::log10(std::max(us, 1.0)) / 5, 0.0, 1.0); }

constexpr double kName_px = 58, kTimes_px = 116;

void draw_stage(Canvas& canvas, const Box& row, const StageGauge& stage) {
  const double y = row.y + row.height / 2;
  canvas.text({row.x, y + 4}, stage.stage, theme::kSmall, theme::kInk);
  const Box scale{row.x + kName_px, row.y, std::max(row.width - kName_px - kTimes_px, 10.0),
                  row.height};
  const std::array<Line, 1> axis{Line{{scale.x, y}, {scale.right(), y}}};
  canvas.stroke(axis, theme::kLine, 1);
  const double from = scale.x + scale.width * logarithmic(stage.p50_us),
               to = scale.x + scale.width * logarithmic(stage.p99_us);
  const std::array<Line, 1> range{Line{{from, y}, {to, y}}};
  canvas.stroke(range, theme::kTail.with_alpha(0.65f), 3);
  canvas.disc({to, y}, 2.6, theme::kTail);
  canvas.disc({from, y}, 3.2, theme::kMedian);
  canvas.text({row.right() - kTimes_px / 2, y + 4}, in_time(stage.p50_us), theme::kSmall,
              theme::kInk, Align::right);
  canvas.text({row.right(), y + 4}, in_time(stage.p99_us), theme::kSmall, theme::kQuiet,
              Align::right);
}

}  // namespace

void draw_rates(Canvas& canvas, const Box& box, const Gauges& gauges) {
  if (gauges.rates.empty()) return;
  const double count = static_cast<double>(gauges.rates.size());
  const double width = (box.width - (count - 1) * 2 * kInset_px) / count;
  for (std::size_t i = 0; i < gauges.rates.size(); ++i)
    draw_rate(canvas,
              {box.x + static_cast<double>(i) * (width + 2 * kInset_px), box.y, width, box.height},
              gauges.rates[i]);
}

void draw_ages(Canvas& canvas, const Box& box, const Gauges& gauges) {
  double largest = 0;
  for (const auto& age : gauges.ages) largest = std::max<double>(largest, largest_of(age.age_ms));
  const double top = rounded_up(largest);
  const double third = box.width / std::max<double>(static_cast<double>(gauges.ages.size()), 1);
  const Box graph{box.x + 26, box.y + 48, box.width - 26, box.height - 48};
  for (const double share : {0.5, 1.0}) {
    const double y = graph.bottom() - share * graph.height;
    canvas.dash({{graph.x, y}, {graph.right(), y}}, theme::kLine, 1);
    canvas.text({graph.x - 6, y + 4}, fmt::format("{:g}", share * top), theme::kSmall,
                theme::kQuiet, Align::right);
  }
  base_line(canvas, graph);
  for (std::size_t i = 0; i < gauges.ages.size(); ++i) {
    const auto& age = gauges.ages[i];
    const auto colour = theme::kAges[i % theme::kAges.size()];
    const double x = box.x + static_cast<double>(i) * third;
    canvas.disc({x + 4, box.y + 8}, 3.5, colour);
    canvas.text({x + 13, box.y + 12}, age.of, theme::kText, theme::kQuiet);
    const auto number = age.age_ms.empty() ? "–" : fmt::format("{:.1f}", age.age_ms.back());
    canvas.text({x, box.y + 36}, number, theme::kNumber, theme::kInk);
    canvas.text({x + canvas.width_of(number, theme::kNumber) + 5, box.y + 36}, "ms", theme::kSmall,
                theme::kQuiet);
    const auto points = points_of(graph, age.age_ms, top);
    if (points.size() > 1) canvas.stroke(points, colour, 1.5);
  }
}

void draw_stages(Canvas& canvas, const Box& box, const Gauges& gauges) {
  constexpr std::size_t kColumns = 2;
  constexpr double kMostRow_px = 26;
  const auto rows = (gauges.stages.size() + kColumns - 1) / kColumns;
  if (rows == 0) return;
  const double width = (box.width - 2 * kInset_px) / kColumns;
  const double height = std::min(box.height / static_cast<double>(rows), kMostRow_px);
  for (std::size_t i = 0; i < gauges.stages.size(); ++i) {
    const std::size_t column = i / rows, row = i % rows;
    draw_stage(canvas,
               {box.x + static_cast<double>(column) * (width + 2 * kInset_px),
                box.y + static_cast<double>(row) * height, width, height},
               gauges.stages[i]);
  }
}

}  // namespace handcast::preview
