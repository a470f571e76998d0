// SPDX-License-Identifier: Apache-2.0
#include "services/watch/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ipc/base/join.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/text.hpp"

namespace handcast::watch {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

std::string restarts_text(const Day& day) {
  std::vector<std::string> services;
  for (const auto& [service, reasons] : day.restarts) {
    std::vector<std::string> parts;
    for (const auto& [why, count] : reasons) parts.push_back(fmt::format("{} x {}", count, why));
    services.push_back(fmt::format("{} ({})", service, join(parts, ", ")));
  }
  return services.empty() ? "none" : join(services, "; ");
}

std::string drift_text(const Drift& drift) {
  return fmt::format("{} ({:.1f} mm across, {:.1f} degrees)",
                     drift.moved ? "the tracker has moved; calibrate it" : "none", drift.across_mm,
                     drift.turn_deg);
}

Rows rows_of(const Day& day) {
  Rows rows{
      {"up", fmt::format("{}, started {} x", span_text(day.up_s), day.starts)},
      {"light", fmt::format("on for {}, dark for {}", span_text(day.lit_s), span_text(day.dark_s))},
      {"hands", fmt::format("{}, {} in all, the longest {}",
                            day.visits == 1 ? "1 visit" : fmt::format("{} visits", day.visits),
                            span_text(day.hands_s), span_text(day.longest_visit_s))},
      {"latency", day.latencies.counts.empty()
                      ? "no light"
                      : fmt::format("usually {:.1f} ms, 99 % within {:.1f} ms, worst {:.0f} "
                                    "ms",
                                    day.latencies.quantile_ms(0.5), day.latencies.quantile_ms(0.99),
                                    day.latencies.worst_ms)},
      {"refreshes", fmt::format("{} without a new frame, of {}", day.missed_refreshes,
                                day.frames + day.missed_refreshes)},
      {"restarts", restarts_text(day)}};
  if (day.drift) rows.emplace_back("drift", drift_text(*day.drift));
  rows.emplace_back("disk",
                    fmt::format("{:.1f} GB free of {:.0f} GB", day.disk_free_gb, day.disk_gb));
  return rows;
}

constexpr std::size_t kDate = 10;  ///< characters of "2026-12-24"

/// The time of the day of "2026-12-24 18:00:05".
std::string clock_part(const std::string& moment) {
  return moment.substr(std::min(moment.size(), kDate + 1));
}

std::string span_of(const Fault& fault) {
  if (fault.until.empty()) return fault.since + ", and goes on";
  const auto is_one_day = fault.until.substr(0, kDate) == fault.since.substr(0, kDate);
  return fault.since + " to " + (is_one_day ? clock_part(fault.until) : fault.until);
}

/// The day as a bar: a rectangle for each run of equal minutes.
std::string bar_of(const Day& day) {
  std::string bar =
      "<rect x=\"0\" y=\"0\" width=\"1440\" height=\"40\" fill=\"none\" stroke=\"#999\"/>\n";
  for (std::size_t begin = 0; begin < day.minutes.size();) {
    auto end = day.minutes.find_first_not_of(day.minutes[begin], begin);
    end = std::min(end, day.minutes.size());
    if (day.minutes[begin] != ' ')
      bar += fmt::format("<rect class=\"{}\" x=\"{}\" y=\"0\" width=\"{}\" height=\"40\"/>\n",
                         day.minutes[begin], begin, end - begin);
    begin = end;
  }
  for (int hour = 0; hour <= 24; hour += 3)
    bar += fmt::format("<text x=\"{}\" y=\"64\">{}</text>\n", hour * 60, hour);
  return bar;
}

constexpr const char* kStyle = R"(
body { font: 16px/1.5 sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #222; background: #fff }
h1 { font-size: 1.5rem } h2 { font-size: 1.1rem; margin-top: 2rem }
td, th { text-align: left; vertical-align: top; padding: .15rem 1.5rem .15rem 0 } th { font-weight: 600 }
svg { width: 100%; height: auto; font-size: 20px } svg text { text-anchor: middle; fill: #555 }
.l { fill: #e8b030 } .d { fill: #4a5568 } .f { fill: #c0392b } .bad { color: #c0392b }
)";

}  // namespace

std::string span_text(double seconds) {
  const auto whole = static_cast<long>(std::round(std::clamp(seconds, 0.0, 1e9)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string report_text(const Day& day) {
  auto text = fmt::format("rig '{}', {}\n\n", day.rig, day.date);
  for (const auto& [name, value] : rows_of(day)) text += fmt::format("{:<10} {}\n", name, value);
  text += day.faults.empty() ? "faults     none\n" : "faults\n";
  for (const auto& fault : day.faults) {
    text += fmt::format("  {}\n    {}\n", span_of(fault), fault.sentence);
    if (!fault.black_box.empty()) text += fmt::format("    black box {}\n", fault.black_box);
  }
  if (!day.events.empty()) text += "events\n";
  for (const auto& event : day.events) text += fmt::format("  {}  {}\n", event.time, event.text);
  return printable(text);
}

std::string report_page(const Day& day) {
  auto page = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0} {1}</title>\n"
      "<style>{2}</style>\n<h1>{0}, {1}</h1>\n<svg viewBox=\"-20 0 1480 72\" role=\"img\" "
      "aria-label=\"The day\">\n{3}</svg>\n<p>Yellow: light. Grey: dark on purpose. Red: a fault. "
      "White: the rig is down.</p>\n<table>\n",
      html_of(day.rig), html_of(day.date), kStyle, bar_of(day));
  for (const auto& [name, value] : rows_of(day))
    page += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", name, html_of(value));
  page += fmt::format("</table>\n<h2>Faults</h2>\n{}", day.faults.empty() ? "<p>None.</p>\n" : "");
  if (!day.faults.empty()) page += "<table>\n";
  for (const auto& fault : day.faults)
    page += fmt::format("<tr><th>{}</th><td class=\"bad\">{}</td><td>{}</td></tr>\n",
                        html_of(span_of(fault)), html_of(fault.sentence), html_of(fault.black_box));
  if (!day.faults.empty()) page += "</table>\n";
  page += "<h2>Events</h2>\n<table>\n";
  for (const auto& event : day.events)
    page += fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", event.time, html_of(event.text));
  return page + "</table>\n</html>\n";
}

}  // namespace handcast::watch
