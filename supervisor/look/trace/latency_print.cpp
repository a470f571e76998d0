// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "supervisor/look/trace/latency_table.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

// All bar charts share one logarithmic axis, so that rows can be compared.
constexpr double kAxisBegin_ns = 1e3;  ///< 1 us
constexpr int kDecades = 5, kCellsPerDecade = 6;
constexpr int kCells = kDecades * kCellsPerDecade;
constexpr std::array<const char*, 9> kLevels{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
constexpr const char* kAxis = "1us   10us  100us 1ms   10ms";

std::size_t cell_of(std::int64_t span_ns) {
  const auto decades =
      std::log10(std::max(static_cast<double>(span_ns), kAxisBegin_ns) / kAxisBegin_ns);
  return std::min<std::size_t>(static_cast<std::size_t>(decades * kCellsPerDecade), kCells - 1);
}

/// A bar chart of the distribution from 1 us to 100 ms. A bar is visible even for a single span.
std::string picture_of(const Spans& spans) {
  std::array<std::size_t, kCells> counts{};
  for (const auto span_ns : spans.sorted_ns()) ++counts[cell_of(span_ns)];
  const auto most = std::max<std::size_t>(std::ranges::max(counts), 1);
  std::string picture;
  for (const auto count : counts)
    picture += kLevels[(count * (kLevels.size() - 1) + most - 1) / most];
  return picture;
}

std::string time_of(std::int64_t span_ns) {
  if (span_ns < 1'000'000) return fmt::format("{:.1f} us", ns_to_us(span_ns));
  if (span_ns < 1'000'000'000) return fmt::format("{:.2f} ms", ns_to_ms(span_ns));
  return fmt::format("{:.2f} s", ns_to_seconds(span_ns));
}

std::string figures_of(const Spans& spans) {
  return fmt::format("{:>8} {:>10} {:>10} {:>10} {:>10}  {}\n", spans.count(),
                     time_of(spans.percentile_ns(0.5)), time_of(spans.percentile_ns(0.99)),
                     time_of(spans.percentile_ns(0.999)), time_of(spans.percentile_ns(1)),
                     picture_of(spans));
}

std::string heading(const char* left, const char* right) {
  return fmt::format("{:<20} {:<16} {:>8} {:>10} {:>10} {:>10} {:>10}  {}\n", left, right, "count",
                     "p50", "p99", "p99.9", "max", kAxis);
}

std::string rate_of(double hz) { return hz > 0 ? fmt::format("{:.1f} Hz", hz) : "-"; }

json figures_in_us(const Spans& spans) {
  const auto us = [&](double share) { return ns_to_us(spans.percentile_ns(share)); };
  return {{"count", spans.count()},
          {"p50_us", us(0.5)},
          {"p99_us", us(0.99)},
          {"p999_us", us(0.999)},
          {"max_us", us(1)}};
}

}  // namespace

json to_json(const LatencyTable& table) {
  json stages = json::array(), ways = json::array(), missed = json::array();
  for (const auto& [service, stage, spans] : table.stages) {
    auto& row = stages.emplace_back(figures_in_us(spans));
    row.update({{"service", service}, {"stage", stage}});
  }
  for (const auto& [from, to, spans] : table.ways) {
    auto& row = ways.emplace_back(figures_in_us(spans));
    row.update({{"from", from}, {"to", to}});
  }
  for (const auto& misses : table.misses)
    missed.push_back({{"service", misses.service},
                      {"frames", misses.frames},
                      {"wanted_hz", misses.wanted_hz > 0 ? json(misses.wanted_hz) : json()},
                      {"held_hz", misses.held_hz},
                      {"missed", misses.missed},
                      {"late", misses.late},
                      {"skipped_ids", misses.skipped_ids},
                      {"longest_gap_ms", ns_to_ms(misses.longest_gap_ns)},
                      {"lost_marks", misses.lost_marks}});
  json lights = json::object();
  for (const auto& [projector, light] : table.lights)
    lights[projector] = {{"times_by", msg::name_of(light.source)},
                         {"missed_refreshes", light.missed},
                         {"doubled_frames", light.doubled}};
  return {{"seconds", table.seconds},
          {"stages", stages},
          {"end_to_end", ways},
          {"services", missed},
          {"light", lights}};
}

std::string print_latency(const LatencyTable& table) {
  auto text = fmt::format(
      "Latency over the last {:.1f} s. light: the middle of a frame's time on the surface.\n\n",
      table.seconds);
  text += heading("from", "to");
  for (const auto& [from, to, spans] : table.ways)
    if (spans.count() > 0) text += fmt::format("{:<20} {:<16} ", from, to) + figures_of(spans);
  text += "\n" + heading("service", "stage");
  for (const auto& [service, stage, spans] : table.stages)
    text += fmt::format("{:<20} {:<16} ", service, stage) + figures_of(spans);

  text += fmt::format("\n{:<12} {:>8} {:>10} {:>10} {:>8} {:>8} {:>8} {:>12} {:>12}\n", "service",
                      "frames", "wanted", "held", "missed", "late", "skipped", "longest gap",
                      "marks lost");
  for (const auto& misses : table.misses)
    text +=
        fmt::format("{:<12} {:>8} {:>10} {:>10} {:>8} {:>8} {:>8} {:>12} {:>12}\n", misses.service,
                    misses.frames, rate_of(misses.wanted_hz), rate_of(misses.held_hz),
                    misses.wanted_hz > 0 ? std::to_string(misses.missed) : "-",
                    misses.wanted_hz > 0 ? std::to_string(misses.late) : "-", misses.skipped_ids,
                    time_of(misses.longest_gap_ns), misses.lost_marks);
  for (const auto& [projector, light] : table.lights)
    text += fmt::format(
        "\nlight of {}: {} refreshes without a new frame, {} frames shown for several refreshes; "
        "times by the {}\n",
        projector, light.missed, light.doubled, msg::name_of(light.source));
  return text;
}

}  // namespace handcast::supervisor
