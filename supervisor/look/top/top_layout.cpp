// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "ipc/base/clock.hpp"
#include "supervisor/look/top/top_table.hpp"
#include "supervisor/look/top/units_text.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kHeaderLines = 2;

using Align = Table::Align;

constexpr std::string_view kNone = "–";
constexpr std::size_t kMeterCells = 8;

Span none() { return faint(std::string(kNone)); }

template <class Value, class Text>
Span if_known(const std::optional<Value>& value, Text text, Style style = Style::plain) {
  return value ? Span{text(*value), style} : none();
}

Span number_or_none(pid_t pid) { return pid > 0 ? Span{std::to_string(pid)} : none(); }

Span text_or_none(const std::string& text) { return text.empty() ? none() : Span{harmless(text)}; }

Style style_of_state(const ServiceRow& service) {
  if (service.state == "ready") return Style::good;
  if (service.state == "degraded" || service.state == "failed" || service.state == "gone")
    return Style::bad;
  return service.state == "stopped" ? Style::faint : Style::warning;
}

/// A bar of kMeterCells characters that is full at one whole core.
std::string meter(double cores) {
  static constexpr std::array<std::string_view, 8> kEighths{"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const auto eighths =
      static_cast<std::size_t>(std::lround(std::clamp(cores, 0.0, 1.0) * 8 * kMeterCells));
  std::string bar;
  for (std::size_t i = 0; i < eighths / 8; ++i) bar += "█";
  return bar.append(kEighths[eighths % 8]);
}

Table::Row cells_of(const ServiceRow& service) {
  const auto state = style_of_state(service);
  const auto own = [](const ProcessUsage& usage) { return text_of_bytes(usage.own_bytes()); };
  const auto shared = [](const ProcessUsage& usage) { return text_of_bytes(usage.shared_bytes); };
  const auto threads = [](const ProcessUsage& usage) { return std::to_string(usage.threads); };
  const auto descriptors = [](const ProcessUsage& usage) {
    return std::to_string(usage.descriptors);
  };
  const auto core = [](const ProcessUsage& usage) { return std::to_string(usage.last_core); };
  Table::Row row;
  row.cells = {
      {harmless(service.name), Style::strong},
      {"● " + harmless(service.state), state},
      text_or_none(service.backend),
      number_or_none(service.pid),
      number_or_none(service.standby_pid),
      if_known(service.cores, text_of_share),
      {service.cores ? meter(*service.cores) : "", Style::heading},
      if_known(service.usage, own),
      if_known(service.usage, shared),
      if_known(service.usage, threads),
      if_known(service.usage, descriptors),
      if_known(service.usage, core),
      text_or_none(service.usage ? scheduling_of(*service.usage) : ""),
      {std::to_string(service.restarts), service.restarts > 0 ? Style::warning : Style::plain},
      service.uptime_s > 0 ? Span{text_of_span(seconds_to_ns(service.uptime_s))} : none(),
      text_or_none(service.last_exit)};
  if (!service.well() && !service.trouble.empty())
    row.note = {{"    └ ", state}, {harmless(service.trouble), state}};
  return row;
}

Span growing(std::uint64_t count, std::optional<double> hz, Style style_of_growth) {
  const bool grows = hz.value_or(0) > 0;
  return {text_of_count(count), grows ? style_of_growth : count > 0 ? Style::plain : Style::faint};
}

Span growth(std::optional<double> hz, Style style) {
  if (!hz || *hz <= 0) return none();
  return {fmt::format("+{:.3g}/s", *hz), style};
}

Table::Row cells_of(const RingRow& ring) {
  const Style late = ring.late() ? Style::warning : Style::plain;
  return {{{ring.now.stream, Style::strong},
           if_known(ring.rate_hz, text_of_rate, late),
           if_known(ring.newest_age_ns, text_of_span, late),
           if_known(ring.latency_ns, text_of_span),
           {text_of_count(ring.now.published)},
           growing(ring.now.dropped, ring.dropped_hz, Style::bad),
           growth(ring.dropped_hz, Style::bad),
           {fmt::format("writer {}", ring.now.epoch),
            ring.now.epoch > 1 ? Style::warning : Style::plain}},
          {}};
}

std::string leases_of(const ReaderRow& reader) {
  std::string text;
  for (const auto age_ns : reader.now.lease_ages_ns)
    if (age_ns >= 0) text += (text.empty() ? "holds " : ", ") + text_of_span(age_ns);
  return text;
}

Span doing(const ReaderRow& reader) {
  if (reader.gone) return {"gone", Style::bad};
  const auto leases = leases_of(reader);
  if (!leases.empty()) return {leases, reader.holds_an_old_lease() ? Style::warning : Style::plain};
  return reader.now.waiting ? faint("sleeps") : none();
}

Table::Row cells_of(const ReaderRow& reader, bool last) {
  const auto branch = last ? "  └ " : "  ├ ";
  return {{{branch + harmless(reader.who)},
           if_known(reader.received_hz, text_of_rate),
           reader.now.received > 0 ? Span{text_of_span(reader.now.age_ns)} : none(),
           reader.now.received > 0 ? Span{text_of_count(reader.now.lag)} : none(),
           {text_of_count(reader.now.received)},
           growing(reader.now.skipped, reader.skipped_hz, Style::warning),
           growth(reader.skipped_hz, Style::warning),
           doing(reader)},
          {}};
}

/// The services, a row each; what is wrong with one stands below its row.
Table service_table(const TopModel& model) {
  Table table;
  table.columns = {{.title = "SERVICE", .align = Align::left, .least = 10, .importance = 100},
                   {.title = "STATE", .align = Align::left, .least = 10, .importance = 98},
                   {.title = "BACK END", .align = Align::left, .least = 8, .importance = 50},
                   {.title = "PID", .least = 7, .importance = 80},
                   {.title = "STANDBY", .least = 7, .importance = 40},
                   {.title = "CPU", .least = 6, .importance = 95},
                   {.title = "", .align = Align::left, .least = kMeterCells, .importance = 15},
                   {.title = "MEMORY", .least = 8, .importance = 90},
                   {.title = "SHARED", .least = 8, .importance = 45},
                   {.title = "THREADS", .importance = 30},
                   {.title = "FILES", .importance = 20},
                   {.title = "CORE", .importance = 10},
                   {.title = "CLASS", .align = Align::left, .least = 7, .importance = 70},
                   {.title = "RESTARTS", .importance = 85},
                   {.title = "UP", .least = 9, .importance = 60},
                   {.title = "LAST EXIT", .align = Align::left, .importance = 75}};
  for (const auto& service : model.services) table.rows.push_back(cells_of(service));
  return table;
}

/// The rings, each with its readers below it. `with_marks`: also the rings of stage marks.
Table ring_table(const TopModel& model, bool with_marks) {
  Table table;
  table.columns = {
      {.title = "RING",
       .second_title = "  ├ reader",
       .align = Align::left,
       .least = 18,
       .importance = 100},
      {.title = "RATE", .second_title = "reads", .least = 8, .importance = 95},
      {.title = "AGE", .second_title = "at reading", .least = 8, .importance = 90},
      {.title = "LATENCY", .second_title = "behind", .least = 8, .importance = 50},
      {.title = "MESSAGES", .second_title = "read", .least = 9, .importance = 40},
      {.title = "DROPPED", .second_title = "skipped", .least = 7, .importance = 80},
      {.title = "", .second_title = "", .least = 8, .importance = 60},
      {.title = "NOW", .second_title = "", .align = Align::left, .least = 12, .importance = 70}};
  for (const auto& ring : model.rings) {
    if (ring.marks() && !with_marks) continue;
    table.rows.push_back(cells_of(ring));
    for (const auto& reader : ring.readers)
      table.rows.push_back(cells_of(reader, &reader == &ring.readers.back()));
  }
  return table;
}

int problems_of(const TopModel& model) {
  const auto ill =
      std::ranges::count_if(model.services, [](const auto& service) { return !service.well(); });
  const auto bad_reader = [](const auto& reader) {
    return reader.gone || reader.holds_an_old_lease();
  };
  auto rings = std::ranges::count_if(model.rings,
                                     [](const auto& ring) { return ring.late() || ring.drops(); });
  for (const auto& ring : model.rings) rings += std::ranges::count_if(ring.readers, bad_reader);
  return static_cast<int>(ill + rings);
}

Line head_line(const TopModel& model) {
  Line line{{"handcast ", Style::faint},
            {harmless(model.rig), Style::strong},
            faint(fmt::format("  up {}", text_of_span(seconds_to_ns(model.uptime_s))))};
  const int problems = problems_of(model);
  if (!model.missing.empty())
    line.push_back({"  the supervisor does not answer: " + harmless(model.missing), Style::bad});
  else if (problems == 0)
    line.push_back({"  all well", Style::good});
  else
    line.push_back({fmt::format("  problems: {}", problems), Style::warning});
  return line;
}

/// The shares of the rungs that the gate chose.
Line rung_line(const TopModel& model) {
  Line line{{"RUNGS", Style::heading}};
  for (const auto& [rung, share] : model.rungs) {
    line.push_back({fmt::format("  {} ", rung)});
    line.push_back({text_of_share(share), Style::strong});
  }
  return line;
}

Line loss_line(const TopModel& model) {
  Line line{{"LOST IMAGES", Style::heading}};
  for (const auto& [reason, count] : model.lost_images) {
    line.push_back({fmt::format("  {} ", reason)});
    line.push_back({fmt::format("{:.0f}", count), Style::warning});
  }
  return line;
}

void append(std::vector<Line>& lines, std::vector<Line> more) {
  std::ranges::move(more, std::back_inserter(lines));
}

}  // namespace

std::vector<Line> lay_out(const TopModel& model, const Page& page) {
  std::vector<Line> lines{cut_to(head_line(model), page.columns), {}};
  append(lines, lay_out(service_table(model), page.columns));
  if (!model.rungs.empty()) {
    lines.emplace_back();
    lines.push_back(cut_to(rung_line(model), page.columns));
  }
  if (!model.lost_images.empty()) lines.push_back(cut_to(loss_line(model), page.columns));
  lines.emplace_back();
  append(lines, lay_out(ring_table(model, page.with_marks), page.columns));
  return lines;
}

std::vector<Line> fit(const std::vector<Line>& lines, std::size_t columns, std::size_t rows,
                      std::size_t& first) {
  const auto head = std::min({kHeaderLines, lines.size(), rows});
  const auto room = rows > head + 1 ? rows - head - 1 : 0;
  const auto body = lines.size() - head;
  first = std::min(first, body > room ? body - room : 0);
  const auto shown = std::min(room, body - first);

  std::vector<Line> seen(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(head));
  const auto from = lines.begin() + static_cast<std::ptrdiff_t>(head + first);
  seen.insert(seen.end(), from, from + static_cast<std::ptrdiff_t>(shown));
  if (rows <= head) return seen;
  seen.resize(rows - 1);
  const auto below = body - first - shown;
  Line keys{faint("q quit   m stage marks")};
  if (below > 0 || first > 0)
    keys.push_back(faint(fmt::format("   ↑↓ scroll ({} above, {} below)", first, below)));
  seen.push_back(cut_to(std::move(keys), columns));
  return seen;
}

}  // namespace handcast::supervisor
