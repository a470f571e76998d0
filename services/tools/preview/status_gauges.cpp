// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/status_gauges.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "ipc/msg/stage_mark.hpp"

namespace handcast::preview {

void Series::add(float value) {
  if (values_.size() == most_) values_.erase(values_.begin());
  values_.push_back(value);
}

void RateMeter::saw(std::uint64_t sequence, std::int64_t published_ns) {
  if (first_ == 0 || sequence < last_) first_ = sequence, first_ns_ = published_ns;
  last_ = sequence;
  last_ns_ = published_ns;
}

double RateMeter::take_hz() {
  // Any two times may have been reported: as integers, they might overflow.
  const double span_s = 1e-9 * (static_cast<double>(last_ns_) - static_cast<double>(first_ns_));
  const double hz = span_s > 0 ? static_cast<double>(last_ - first_) / span_s : 0.0;
  first_ = last_;
  first_ns_ = last_ns_;
  return hz;
}

namespace {

using nlohmann::json;

/// The value at a path of keys; null if there is none.
const json& at(const json& object, std::initializer_list<std::string_view> keys) {
  static const json kNone;
  const json* here = &object;
  for (const auto key : keys) {
    if (!here->is_object()) return kNone;
    const auto found = here->find(std::string(key));
    if (found == here->end()) return kNone;
    here = &*found;
  }
  return *here;
}

std::optional<double> number(const json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

std::string text(const json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace

std::optional<double> wanted_hz(const json& status, std::string_view stream) {
  const auto hz = number(at(status, {"rings", stream, "wanted_hz"}));
  return hz && *hz > 0 ? hz : std::nullopt;
}

void read_status(const json& status, config::Viewpoint projector, Gauges& gauges) {
  gauges.uptime_s = number(at(status, {"uptime_s"})).value_or(0);
  if (const auto& services = at(status, {"services"}); services.is_object())
    for (const auto& [name, service] : services.items()) {
      const auto state = text(at(service, {"state"}));
      if (state == "ready" || state == "stopped") continue;
      const auto reason = text(at(service, {"reason"}));
      gauges.ill.push_back(
          fmt::format("{} is {}{}{}", name, state, reason.empty() ? "" : ": ", reason));
    }
  gauges.stages.clear();
  constexpr auto kFirstOfFrame = static_cast<std::size_t>(msg::Stage::predict);
  for (std::size_t i = 0; i < msg::kStageNames.size(); ++i) {
    const std::string stage(msg::kStageNames[i]);
    const bool is_of_second = projector == config::Viewpoint::second && i >= kFirstOfFrame;
    const auto& times = at(status, {"stage_us", is_of_second ? stage + "2" : stage});
    const auto p50 = number(at(times, {"p50"})), p99 = number(at(times, {"p99"}));
    if (p50 && p99) gauges.stages.push_back({stage, *p50, *p99});
  }
}

}  // namespace handcast::preview
