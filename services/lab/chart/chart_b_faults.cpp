// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "services/lab/chart/chart.hpp"
#include "services/lab/chart/fault.hpp"
#include "services/lab/chart/methods.hpp"
#include "services/lab/chart/script.hpp"

namespace handcast::chart {
namespace {

constexpr int kWidth_px = 1060;
constexpr double kRow_px = 24, kNames_px = 422, kDots_px = 700, kTop_px = 96;

/// Of kCompared: dots at one place are all seen.
constexpr std::array kDotSizes{0.45, 0.75, 1.1};

/// One block of rows, with the metric of its dots. The columns on the right hold another.
struct Block {
  std::string title, axis, columns_title;
  std::vector<const Failure*> rows;
  std::optional<double> Damage::*dot;
};

const Damage* damage_of(const Failure& failure, std::string_view variant) {
  const auto found = failure.damage.find(std::string(variant));
  return found == failure.damage.end() ? nullptr : &found->second;
}

std::vector<Block> blocks_of(const std::vector<Failure>& failures) {
  const auto error = "interior error p95, mm", lit = "hand lit, %";
  std::vector<Block> blocks{
      {"For a moment",
       "worst landmark error, mm",
       "recovery, ms (* the paper's is faster)",
       {},
       &Damage::worst_mm},
      {"For the whole run", error, lit, {}, &Damage::p95_mm},
      {"Difficult motions, and a wave for comparison", error, lit, {}, &Damage::p95_mm},
  };
  for (const auto& failure : failures)
    blocks[static_cast<std::size_t>(failure.kind)].rows.push_back(&failure);
  std::erase_if(blocks, [](const Block& block) { return block.rows.empty(); });
  return blocks;
}

double height_px(const Block& block) {
  return kTop_px + kRow_px * static_cast<double>(block.rows.size()) + 34;
}

std::string words_of(const Damage& damage, FailureKind kind) {
  if (kind != FailureKind::passing)
    return damage.coverage ? fmt::format("{:.1f}", 100 * *damage.coverage) : "–";
  if (damage.never_good > 0) return "never";
  return damage.recovery_ms ? fmt::format("{:.0f}", *damage.recovery_ms) : "–";
}

Range range_of_dots(const Block& block) {
  std::vector<double> values;
  for (const auto* failure : block.rows)
    for (const auto& [variant, damage] : failure->damage)
      if (const auto value = damage.*block.dot; value && *value > 0) values.push_back(*value);
  return range_of(values, true);
}

void draw_row(Script& script, const Block& block, std::size_t row, double y_px) {
  const auto& failure = *block.rows[row];
  script.text(kNames_px - 12, y_px, failure.name, {kInk, "right", 12});
  script.stroke({kNames_px, y_px}, {kDots_px, y_px}, kLine);
  for (std::size_t i = std::size(kCompared); i-- > 0;) {  // the smaller dots above the larger ones
    const auto method = method_of(kCompared[i]);
    const auto* damage = damage_of(failure, method.variant);
    if (!damage) continue;
    const Point dot{(damage->*block.dot).value_or(0),
                    static_cast<double>(block.rows.size() - row) - 0.5};
    if (dot.x > 0)
      script.series({&dot, 1}, fmt::format("points pt 7 ps {} lc rgb \"{}\"", kDotSizes[i],
                                           method.colour.value));
    const bool ours = method.variant == "handcast";
    const auto* paper = damage_of(failure, "paper");
    const bool slower =
        ours && failure.kind == FailureKind::passing && paper && recovers_faster(*paper, *damage);
    script.text(kDots_px + 110 + 95 * static_cast<double>(i), y_px,
                words_of(*damage, failure.kind) + (slower ? "*" : ""),
                {method.colour, "right", 12, ours});
  }
}

void draw(Script& script, const Block& block, double top_px) {
  const double first_px = top_px + kTop_px, count = static_cast<double>(block.rows.size());
  script.panel({kNames_px, first_px, kDots_px, first_px + kRow_px * count}, range_of_dots(block),
               {0, count});
  script.line("unset ytics\nset border 0\nset grid noytics");
  script.text(20, top_px + 24, block.title, {kInk, "left", 15, true});
  script.text(kNames_px, first_px - 34, block.axis, {kQuiet, "left", 12});
  script.text(kDots_px + 300, first_px - 34, block.columns_title, {kQuiet, "right", 12});
  for (std::size_t i = 0; i < std::size(kCompared); ++i) {
    const auto method = method_of(kCompared[i]);
    script.text(kDots_px + 110 + 95 * static_cast<double>(i), first_px - 14, kCompared[i],
                {method.colour, "right", 12, true});
  }
  for (std::size_t row = 0; row < block.rows.size(); ++row)
    draw_row(script, block, row, first_px + kRow_px * (static_cast<double>(row) + 0.5));
  script.plot();
}

std::string script_of(const std::vector<Block>& blocks) {
  double whole_px = 0;
  for (const auto& block : blocks) whole_px += height_px(block);
  Script script("chart_b_faults", kWidth_px, static_cast<int>(whole_px));
  double top_px = 0;
  for (const auto& block : blocks) {
    draw(script, block, top_px);
    top_px += height_px(block);
  }
  return script.finish();
}

constexpr const char* kKindNames[] = {"for a moment", "for the whole run", "motion"};

NumberTable table_of(const std::vector<Failure>& failures) {
  NumberTable table{"chart_b_faults",
                    "Worst error, recovery and time without light are of the landmarks, and the "
                    "largest over the motions of the sweep. Recovery is the time from the end of "
                    "the fault until the error stays for 100 ms within half the usual error of "
                    "the same run without the fault. The other figures are of the whole run: "
                    "means over the motions, and the largest number of fold-overs. Simulated: the "
                    "same on all machines.",
                    {{"failure", "failure"},
                     {"kind", "kind"},
                     {"method", "method"},
                     {"worst_mm", "worst, mm", 1},
                     {"recovery_ms", "recovery, ms", 0},
                     {"paper_faster", "the paper's recovers faster"},
                     {"dark_ms", "without light, ms", 0},
                     {"interior_mm_p95", "interior p95, mm", 2},
                     {"coverage", "coverage", 3},
                     {"spill", "spill", 3},
                     {"foldovers", "fold-overs", 0}},
                    {}};
  for (const auto& failure : failures)
    for (const auto variant : kCompared) {
      const auto* damage = damage_of(failure, variant);
      if (!damage) continue;
      const Cell recovery =
          damage->never_good > 0 ? Cell("not within the run") : Cell(damage->recovery_ms);
      const auto* paper = damage_of(failure, "paper");
      const bool slower = variant == "handcast" && paper && recovers_faster(*paper, *damage);
      table.rows.push_back({failure.name, kKindNames[static_cast<int>(failure.kind)],
                            std::string(variant), damage->worst_mm, recovery, slower ? "yes" : "",
                            damage->dark_ms, damage->p95_mm, damage->coverage, damage->spill,
                            damage->foldovers});
    }
  return table;
}

std::string recovery_words(const Damage& damage) {
  return damage.never_good > 0 ? "does not within the run"
                               : fmt::format("{:.0f} ms", damage.recovery_ms.value_or(0));
}

/// The failures of which the paper's cascade recovers faster than ours, in words.
std::string slower_than_paper(const std::vector<Failure>& failures) {
  std::string list;
  std::size_t passing = 0, slower = 0;
  for (const auto& failure : failures) {
    if (failure.kind != FailureKind::passing) continue;
    const auto *paper = damage_of(failure, "paper"), *ours = damage_of(failure, "handcast");
    if (!paper || !ours) continue;
    ++passing;
    if (!recovers_faster(*paper, *ours)) continue;
    ++slower;
    list += fmt::format("{}{}: {}, ours {}", list.empty() ? "" : "; ", failure.name,
                        recovery_words(*paper), recovery_words(*ours));
  }
  if (passing == 0) return "";
  if (slower == 0)
    return fmt::format(" The paper's cascade recovers faster than ours in none of {} failures.",
                       passing);
  return fmt::format(" The paper's cascade recovers faster than ours in {} of {} failures ({}).",
                     slower, passing, list);
}

}  // namespace

Chart chart_b_faults(const Results& results) {
  Chart chart{"chart_b_faults",
              "B. The failure atlas",
              "The failures of a rig: how far its landmarks are off from each of them on, and the "
              "time until they are good again; of what lasts, the light.",
              {},
              {},
              {}};
  const auto failures = failures_of(results);
  if (failures.empty()) {
    chart.lacking = "needs drawn runs with failures: sweep config/sweeps/failures.toml";
    return chart;
  }
  chart.reading += slower_than_paper(failures);
  chart.script = script_of(blocks_of(failures));
  chart.tables.push_back(table_of(failures));
  return chart;
}

}  // namespace handcast::chart
