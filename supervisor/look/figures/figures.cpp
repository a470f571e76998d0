// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/figures/figures.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>

namespace handcast::supervisor {
namespace {

using nlohmann::json;

/// Each member and its name in JSON, for Writer and Reader. or_null(): null if it is empty or 0.
/// @{
template <class Visitor>
void describe(Visitor& visit, ServiceFigures& service) {
  visit("state", service.state);
  visit("pid", service.pid);
  visit.or_null("standby", service.standby_pid);
  visit("backend", service.backend);
  visit.or_null("instead_of", service.instead_of);
  visit("uptime_s", service.uptime_s);
  visit("restarts", service.restarts);
  visit.or_null("last_exit", service.last_exit);
  visit.or_null("reason", service.reason);
  visit("retry_s", service.retry_s);
  visit("silent_ms", service.silent_ms);
  visit("log", service.log);
}
template <class Visitor>
void describe(Visitor& visit, StreamFigures& stream) {
  visit("wanted_hz", stream.wanted_hz);
  visit("held_hz", stream.held_hz);
  visit("is_held_to_it", stream.is_held_to_it);
  visit("is_settled", stream.is_settled);
  visit("count", stream.count);
  visit("newest_age_ms", stream.newest_age_ms);
}
template <class Visitor>
void describe(Visitor& visit, LightFigures& light) {
  visit("times_by", light.times_by);
  visit("missed_refreshes", light.missed_refreshes);
  visit("doubled_frames", light.doubled_frames);
}
template <class Visitor>
void describe(Visitor& visit, SlowFrameFigures& slow) {
  visit("count", slow.count);
  visit("least_us", slow.least_us);
  visit("preempted", slow.preempted);
  visit("interrupted", slow.interrupted);
  visit("page_faults", slow.page_faults);
  visit("own", slow.own);
}
template <class Visitor>
void describe(Visitor& visit, DriftFigures& drift) {
  visit("moved", drift.moved);
  visit("places", drift.places);
  visit("across_mm", drift.across_mm);
  visit("turn_deg", drift.turn_deg);
}
template <class Visitor>
void describe(Visitor& visit, BridgeFigures& bridge) {
  visit("clock_error_us", bridge.clock_error_us);
  visit("refused", bridge.refused);
}
template <class Visitor>
void describe(Visitor& visit, StageFigures& stage) {
  visit("p50", stage.p50_us);
  visit("p99", stage.p99_us);
  visit("count", stage.count);
}
template <class Visitor>
void describe(Visitor& visit, Figures& figures) {
  visit("rig", figures.rig);
  visit("uptime_s", figures.uptime_s);
  visit("keeper_died", figures.keeper_died);
  visit("services", figures.services);
  visit("rings", figures.streams);
  visit("light", figures.lights);
  visit("slow_frames", figures.slow_frames);
  visit("lost_images", figures.lost_images);
  visit("tracker_faults", figures.tracker_faults);
  visit("tracker_drift", figures.tracker_drift);
  visit("bridge", figures.bridge);
  visit("stage_us", figures.stages);
  visit("rungs", figures.rungs);
}
/// @}

struct Writer {
  json object = json::object();

  template <class T>
  void operator()(const char* key, T& member) {
    object[key] = written(member);
  }
  template <class T>
  void or_null(const char* key, T& member) {
    object[key] = member == T() ? json() : json(member);
  }

  template <class T>
  static json written(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_constructible_v<std::string, T> ||
                  std::is_same_v<T, std::vector<std::string>>) {
      return value;
    } else {
      Writer writer;
      describe(writer, value);
      return writer.object;
    }
  }
  template <class T>
  static json written(std::optional<T>& value) {
    return value ? written(*value) : json();
  }
  template <class T>
  static json written(std::map<std::string, T>& values) {
    json object = json::object();
    for (auto& [key, value] : values) object[key] = written(value);
    return object;
  }
};

struct Reader {
  const json& object;

  template <class T>
  void operator()(const char* key, T& member) {
    if (const auto found = object.find(key); found != object.end()) read(*found, member);
  }
  template <class T>
  void or_null(const char* key, T& member) {
    (*this)(key, member);
  }

  /// False if the value has another type.
  /// @{
  static bool read(const json& value, bool& member) {
    return value.is_boolean() && (member = value.get<bool>(), true);
  }
  static bool read(const json& value, std::string& member) {
    return value.is_string() && (member = value.get<std::string>(), true);
  }
  static bool read(const json& value, std::vector<std::string>& member) {
    if (!value.is_array()) return false;
    for (const auto& each : value)
      if (each.is_string()) member.push_back(each.get<std::string>());
    return true;
  }
  template <class T>
  static bool read(const json& value, T& member) {
    if constexpr (std::is_integral_v<T> && sizeof(T) == sizeof(std::uint64_t)) {
      if (value.is_number_unsigned() || (value.is_number_integer() && value >= 0))
        return member = value.get<T>(), true;
    }
    if constexpr (std::is_arithmetic_v<T>) {
      if (!value.is_number()) return false;
      member = static_cast<T>(std::clamp(value.get<double>(), 0.0, 1e9));
    } else {
      if (!value.is_object()) return false;
      Reader reader{value};
      describe(reader, member);
    }
    return true;
  }
  template <class T>
  static bool read(const json& value, std::optional<T>& member) {
    T read_value{};
    if (read(value, read_value)) member = std::move(read_value);
    return true;
  }
  template <class T>
  static bool read(const json& value, std::map<std::string, T>& members) {
    if (!value.is_object()) return false;
    for (const auto& [key, each] : value.items())
      if (T member{}; read(each, member)) members.emplace(key, std::move(member));
    return true;
  }
  /// @}
};

}  // namespace

bool StreamFigures::slow() const {
  constexpr double kEnough = 0.9;
  return is_held_to_it && is_settled && wanted_hz && held_hz < kEnough * *wanted_hz;
}

json to_json(Figures figures) { return Writer::written(figures); }

Figures figures_in(const json& status) {
  Figures figures;
  Reader::read(status, figures);
  return figures;
}

}  // namespace handcast::supervisor
