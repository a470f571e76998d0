// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/columns.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

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
  const auto add = [&](const std::string& column, const std::string& place) {
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
       {"missing", "off_10mm", "coverage", "spill", "iou", "seam_px", "jitter_px",
        "landmark_jitter_px", "foldovers", "equivalent_latency_ms", "residual_px", "jnd_ms",
        "late_jnds", "software_ms", "motion_to_photon_ms"})
    add(plain, fmt::format("/{}", plain));
  for (const char* of_fault : {"usual_mm", "worst_mm", "dark_ms", "recovery_ms"})
    add(fmt::format("fault_{}", of_fault), fmt::format("/fault/{}", of_fault));
  add("detector", "/detector/backend");  // a word
  for (const char* of_detector : {"age_ms", "ms_p50", "missed", "invented"})
    add(fmt::format("detector_{}", of_detector), fmt::format("/detector/{}", of_detector));
  add("detector_px_mean", "/detector/error_px/mean");
  add("detector_px_p95", "/detector/error_px/p95");
  add("hand_speed_m_s_mean", "/hand_speed_m_s/mean");
  add("hand_speed_m_s_p95", "/hand_speed_m_s/p95");
  for (const auto rung : msg::kRungNames)
    add(fmt::format("rung_share_{}", rung), fmt::format("/rungs/{}", rung));
  add("frame_us_p50", "/frame_us/p50");
  add("frame_us_p99", "/frame_us/p99");
  for (auto stage = msg::Stage::predict; stage < msg::Stage::frame;
       stage = static_cast<msg::Stage>(static_cast<int>(stage) + 1)) {
    const auto name = msg::kStageNames[static_cast<std::size_t>(stage)];
    add(fmt::format("stage_us_{}_p50", name), fmt::format("/stage_us/{}/p50", name));
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

/// A number or a word. Empty if there is neither.
std::string print_figure(const nlohmann::json& json, const nlohmann::json::json_pointer& place) {
  if (!json.contains(place)) return {};
  if (json[place].is_string()) return json[place].get<std::string>();
  return json[place].is_number() ? fmt::format("{:.9g}", json[place].get<double>()) : "";
}

}  // namespace

Heading heading_of(const Plan& plan, const Expansion& expansion, std::string_view version) {
  Heading heading{fmt::format("{}version={} fingerprint={} runs={} plan={}", kStampStart, version,
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

}  // namespace handcast::sweep
