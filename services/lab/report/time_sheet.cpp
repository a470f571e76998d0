// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/time_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "ipc/msg/stage_mark.hpp"
#include "services/tools/page/html.hpp"

namespace handcast::report {
namespace {

struct Column {
  const char* name;
  const Source& source;
};

struct Group {
  const char* title;
  const char* sentence;
  msg::Stage first, last;
};

constexpr Group kGroups[] = {
    {"One projector frame",
     "The steps in their order; frame: all of them; present: handing the frame to the projector; "
     "light: the time from there to the middle of its light.",
     msg::Stage::predict, msg::Stage::light},
    {"Sensors",
     "capture and sample: the age of an image or pose when it is published; detect: the duration "
     "of a detection.",
     msg::Stage::capture, msg::Stage::detect},
};

std::optional<double> time_us(const Column& column, const std::string& stage, const char* which) {
  return column.source.number(nlohmann::json::json_pointer("/stage_us") / stage /
                              std::string(which));
}

/// The stages of a group for which any column has a time.
std::vector<std::string> stages_of(const Group& group, std::span<const Column> columns) {
  std::vector<std::string> stages;
  for (auto i = static_cast<std::size_t>(group.first); i <= static_cast<std::size_t>(group.last);
       ++i) {
    const std::string stage(msg::kStageNames[i]);
    const auto has_time = [&](const Column& column) {
      return time_us(column, stage, "p50").has_value();
    };
    if (std::any_of(columns.begin(), columns.end(), has_time)) stages.push_back(stage);
  }
  return stages;
}

/// A solid bar for the median and a pale one for the 99th percentile, both clipped at the edge.
std::string bar(const Column& column, const std::string& stage, double full_us) {
  const auto p50 = time_us(column, stage, "p50"), p99 = time_us(column, stage, "p99");
  if (!p50) return "";
  const auto percent = [&](double value_us) { return std::min(100.0, 100 * value_us / full_us); };
  return fmt::format(
      "<div class=\"bar\"><span class=\"who\">{}</span><span class=\"track\"><i class=\"p99\" "
      "style=\"width:{:.1f}%\"></i><i class=\"p50\" "
      "style=\"width:{:.1f}%\"></i></span><span class=\"value\">{} <small>/ "
      "{}</small></span></div>\n",
      column.name, percent(p99.value_or(*p50)), percent(*p50), page::figure(p50, 0),
      page::figure(p99, 0));
}

std::string group_sheet(const Group& group, std::span<const Column> columns) {
  const auto stages = stages_of(group, columns);
  if (stages.empty()) return "";
  double full_us = 1;
  for (const auto& stage : stages)
    for (const auto& column : columns)
      full_us = std::max(full_us, 1.35 * time_us(column, stage, "p50").value_or(0));
  std::string sheet = fmt::format("<h3>{}</h3><p class=\"quiet\">{}</p>\n<div class=\"sheet\">\n",
                                  group.title, group.sentence);
  for (const auto& stage : stages) {
    sheet += fmt::format("<div class=\"stage\"><b>{}</b><div>\n", stage);
    for (const auto& column : columns) sheet += bar(column, stage, full_us);
    sheet += "</div></div>\n";
  }
  return sheet + "</div>\n";
}

}  // namespace

std::string time_sheet(const Inputs& inputs) {
  const Column columns[] = {{"live", inputs.live}, {"simulated", inputs.runs[2].metrics}};
  std::string sheets;
  for (const auto& group : kGroups) sheets += group_sheet(group, columns);
  if (sheets.empty())
    return page::missing("Neither live.json nor twin.json has the times of the stages.");
  return "<p>Microseconds, median / 99th percentile.</p>\n" + sheets;
}

}  // namespace handcast::report
