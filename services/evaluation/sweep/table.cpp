// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/sweep/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>

#include "config/settings/files.hpp"
#include "ipc/base/write_whole.hpp"
#include "ipc/msg/rung.hpp"
#include "ipc/msg/stage_mark.hpp"

namespace handcast::sweep {
namespace {

struct Metric {
  std::string column;
  nlohmann::json::json_pointer place;  ///< in the result of simulate::score
};

std::vector<Metric> make_metrics() {
  std::vector<Metric> metrics;
  const auto add = [&](const char* column, const char* place) {
    metrics.push_back({column, nlohmann::json::json_pointer(place)});
  };
  add("interior_mm_mean", "/interior_mm/mean");
  add("interior_mm_p95", "/interior_mm/p95");
  add("interior_mm_p99", "/interior_mm/p99");
  add("interior_px_p95", "/interior_px/p95");
  add("landmark_mm_mean", "/landmark_mm/mean");
  add("landmark_mm_p95", "/landmark_mm/p95");
  add("lit_mm_mean", "/lit_mm/mean");
  add("lit_mm_p95", "/lit_mm/p95");
  for (const char* plain :
       {"missing", "coverage", "spill", "iou", "seam_px", "jitter_px", "landmark_jitter_px",
        "foldovers", "equivalent_latency_ms", "residual_px", "software_ms", "motion_to_photon_ms"})
    add(plain, fmt::format("/{}", plain).c_str());
  for (const char* of_fault : {"usual_mm", "worst_mm", "dark_ms", "recovery_ms"})
    add(fmt::format("fault_{}", of_fault).c_str(), fmt::format("/fault/{}", of_fault).c_str());
  add(std::string(kDetector).c_str(), "/detector/backend");
  for (const char* of_detector : {"age_ms", "ms_p50", "missed", "invented"})
    add(fmt::format("detector_{}", of_detector).c_str(),
        fmt::format("/detector/{}", of_detector).c_str());
  add("detector_px_mean", "/detector/error_px/mean");
  add("detector_px_p95", "/detector/error_px/p95");
  add("hand_speed_m_s_mean", "/hand_speed_m_s/mean");
  add("hand_speed_m_s_p95", "/hand_speed_m_s/p95");
  for (const auto rung : msg::kRungNames)
    add(fmt::format("rung_share_{}", rung).c_str(), fmt::format("/rungs/{}", rung).c_str());
  add("frame_us_p50", "/frame_us/p50");
  add("frame_us_p99", "/frame_us/p99");
  for (auto stage = msg::Stage::predict; stage < msg::Stage::frame;
       stage = static_cast<msg::Stage>(static_cast<int>(stage) + 1)) {
    const auto name = msg::kStageNames[static_cast<std::size_t>(stage)];
    add(fmt::format("stage_us_{}_p50", name).c_str(),
        fmt::format("/stage_us/{}/p50", name).c_str());
  }
  return metrics;
}

const std::vector<Metric>& metrics() {
  static const auto kMetrics = make_metrics();
  return kMetrics;
}

Row begin_row(const Plan& plan, const Run& run) {
  Row row{fmt::format("{}", run.index), plan.variants[run.variant].name};
  for (const auto& path : plan.axes()) {
    const auto* choice = run.choice(plan, path);
    row.push_back(choice ? choice->shown : "");
  }
  return row;
}

/// A number, or the word of kDetector. Empty if there is neither.
std::string print_figure(const nlohmann::json& json, const nlohmann::json::json_pointer& place) {
  if (!json.contains(place)) return {};
  if (json[place].is_string()) return json[place].get<std::string>();
  return json[place].is_number() ? fmt::format("{:.9g}", json[place].get<double>()) : "";
}

std::string print_cell(std::string cell) {
  std::ranges::replace(cell, '\n', ' ');
  std::ranges::replace(cell, '\r', ' ');
  if (cell.find_first_of(",\"") == cell.npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

Result<void> check_row(const Row& row, const Heading& heading, const std::filesystem::path& file,
                       std::size_t line) {
  std::size_t index = 0;
  const auto& text = row.front();
  const auto read = std::from_chars(text.data(), text.data() + text.size(), index);
  const bool number = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  if (row.size() == heading.columns.size() && number && index < heading.runs()) return {};
  return fail(Errc::bad_data,
              fmt::format("{}:{}: the line is not one of this sweep", file.string(), line));
}

}  // namespace

std::string Heading::print() const { return stamp + "\n" + print_row(columns); }

// 0 also above kMostRuns: no file of results holds so many, and memory is taken by the number.
std::size_t Heading::runs() const {
  constexpr std::size_t kMostRuns = 10'000'000;
  const auto at = stamp.find(" runs=");
  std::size_t count = 0;
  if (at != stamp.npos) std::from_chars(stamp.data() + at + 6, stamp.data() + stamp.size(), count);
  return count <= kMostRuns ? count : 0;
}

Heading heading_of(const Plan& plan, const Expansion& expansion, std::string_view version) {
  Heading heading{fmt::format("# handcast sweep version={} fingerprint={} runs={} plan={}", version,
                              expansion.fingerprint, expansion.runs.size(), plan.name),
                  {"index", "variant"}};
  for (const auto& path : plan.axes()) heading.columns.push_back(path);
  for (const auto& metric : metrics()) heading.columns.push_back(metric.column);
  heading.columns.push_back("error");
  return heading;
}

Row scored_row(const Plan& plan, const Run& run, const nlohmann::json& json) {
  auto row = begin_row(plan, run);
  for (const auto& metric : metrics()) row.push_back(print_figure(json, metric.place));
  row.emplace_back();
  return row;
}

Row failed_row(const Plan& plan, const Run& run, const std::string& error) {
  auto row = begin_row(plan, run);
  row.resize(row.size() + metrics().size());
  row.push_back(error);
  return row;
}

bool is_machine_time(std::string_view column) {
  return column.starts_with("frame_us_") || column.starts_with("stage_us_") ||
         column == "detector_ms_p50";
}

bool is_metric(std::string_view column) {
  return std::ranges::find(metrics(), column, &Metric::column) != metrics().end();
}

std::string print_row(const Row& row) {
  std::string line;
  for (const auto& cell : row) {
    if (&cell != &row.front()) line += ',';
    line += print_cell(cell);
  }
  line += '\n';
  return line;
}

Row parse_row(std::string_view line) {
  Row row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool doubled = quoted && line.substr(i, 2) == "\"\"";
    if (line[i] == '"' && !doubled) {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      row.emplace_back();
    } else {
      row.back() += line[i];
      if (doubled) ++i;
    }
  }
  return row;
}

std::size_t Table::index_of(const Row& row) { return std::stoul(row.front()); }

Result<Table> read_table(const std::filesystem::path& file) {
  const auto text = config::read_text(file);
  if (!text) return tl::make_unexpected(text.error());
  Table table;
  std::size_t line = 1;
  for (std::size_t end = 0; (end = text->find('\n', table.whole_bytes)) != text->npos;
       table.whole_bytes = end + 1, ++line) {
    const auto content = std::string_view(*text).substr(table.whole_bytes, end - table.whole_bytes);
    if (line == 1) {
      table.heading.stamp = content;
    } else if (line == 2) {
      table.heading.columns = parse_row(content);
    } else {
      table.rows.push_back(parse_row(content));
      if (auto good = check_row(table.rows.back(), table.heading, file, line); !good)
        return tl::make_unexpected(good.error());
    }
  }
  table.torn = text->substr(table.whole_bytes);
  if (line > 1 &&
      (!table.heading.stamp.starts_with("# handcast sweep ") || table.heading.runs() == 0))
    return fail(Errc::bad_data,
                fmt::format("{}: the file does not hold results of a sweep", file.string()));
  return table;
}

Result<void> write_table(const std::filesystem::path& file, const Table& table) {
  std::map<std::size_t, const Row*> newest;
  for (const auto& row : table.rows) newest[Table::index_of(row)] = &row;
  std::string text = table.heading.print();
  for (const auto& [index, row] : newest) text += print_row(*row);
  return write_whole(file, text);
}

}  // namespace handcast::sweep
