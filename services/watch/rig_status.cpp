// SPDX-License-Identifier: Apache-2.0
#include "services/watch/rig_status.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace handcast::watch {
namespace {

using nlohmann::json;

const json& part_of(const json& object, const char* name) {
  static const json kNothing;
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? *found : kNothing;
}

double number_in(const json& object, const char* name) {
  const auto& value = part_of(object, name);
  return value.is_number() ? std::clamp(value.get<double>(), 0.0, 1e15) : 0;
}

std::string text_in(const json& object, const char* name) {
  const auto& value = part_of(object, name);
  return value.is_string() ? value.get<std::string>() : "";
}

RigStatus::Service service_in(const json& object) {
  RigStatus::Service service{.state = text_in(object, "state"),
                             .reason = text_in(object, "last_exit"),
                             .restarts = static_cast<int>(number_in(object, "restarts")),
                             .uptime_s = number_in(object, "uptime_s")};
  // What it said itself tells more than how it ended.
  if (service.state == "failed") service.reason = text_in(object, "reason");
  return service;
}

}  // namespace

RigStatus status_in(const json& object) {
  RigStatus status;
  for (const auto& [name, service] : part_of(object, "services").items())
    status.services[name] = service_in(service);
  for (const auto& [stream, ring] : part_of(object, "rings").items())
    status.messages[stream] = static_cast<std::uint64_t>(number_in(ring, "count"));
  if (const auto& drift = part_of(object, "tracker_drift"); drift.is_object()) {
    const auto& moved = part_of(drift, "moved");
    status.drift = Drift{moved.is_boolean() && moved.get<bool>(), number_in(drift, "across_mm"),
                         number_in(drift, "turn_deg")};
  }
  return status;
}

}  // namespace handcast::watch
