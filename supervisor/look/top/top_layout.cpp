// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/top_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "ipc/base/clock.hpp"
#include "supervisor/look/top/rig_tables.hpp"
#include "supervisor/look/top/units_text.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::size_t kHeaderLines = 2;

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
