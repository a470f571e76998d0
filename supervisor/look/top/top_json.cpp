// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "supervisor/look/top/top_model.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

template <class Number>
json or_null(const std::optional<Number>& value) {
  return value ? json(*value) : json();
}

json json_of(const ServiceRow& service) {
  json object{{"service", service.name},
              {"state", service.state},
              {"backend", service.backend},
              {"pid", service.pid},
              {"standby_pid", service.standby_pid},
              {"restarts", service.restarts},
              {"uptime_s", service.uptime_s},
              {"last_exit", service.last_exit},
              {"cores", or_null(service.cores)}};
  if (!service.well()) object["trouble"] = service.trouble;
  if (!service.usage) return object;
  const auto& usage = *service.usage;
  object["resident_bytes"] = usage.resident_bytes;
  object["shared_bytes"] = usage.shared_bytes;
  object["threads"] = usage.threads;
  object["descriptors"] = usage.descriptors;
  object["last_core"] = usage.last_core;
  object["scheduling"] = scheduling_of(usage);
  return object;
}

json json_of(const ReaderRow& reader) {
  json leases = json::array();
  for (const auto age_ns : reader.now.lease_ages_ns)
    if (age_ns >= 0) leases.push_back(age_ns);
  return {{"row", reader.now.row},
          {"pid", reader.now.pid},
          {"who", reader.who},
          {"gone", reader.gone},
          {"received", reader.now.received},
          {"received_hz", or_null(reader.received_hz)},
          {"skipped", reader.now.skipped},
          {"skipped_hz", or_null(reader.skipped_hz)},
          {"unusable", reader.now.unusable},
          {"copied", reader.now.copied},
          {"lag", reader.now.lag},
          {"age_ns", reader.now.age_ns},
          {"lease_ages_ns", leases},
          {"waiting", reader.now.waiting}};
}

json json_of(const RingRow& ring) {
  json readers = json::array();
  for (const auto& reader : ring.readers) readers.push_back(json_of(reader));
  return {{"stream", ring.now.stream},
          {"slots", ring.now.slots},
          {"wanted_hz", or_null(ring.wanted_hz)},
          {"rate_hz", or_null(ring.rate_hz)},
          {"epoch", ring.now.epoch},
          {"published", ring.now.published},
          {"dropped", ring.now.dropped},
          {"dropped_hz", or_null(ring.dropped_hz)},
          {"newest_age_ns", or_null(ring.newest_age_ns)},
          {"latency_ns", or_null(ring.latency_ns)},
          {"late", ring.late()},
          {"readers", readers}};
}

}  // namespace

json json_of(const TopModel& model) {
  json services = json::array(), rings = json::array(), rungs = json::object(),
       lost = json::object();
  for (const auto& service : model.services) services.push_back(json_of(service));
  for (const auto& ring : model.rings) rings.push_back(json_of(ring));
  for (const auto& [rung, share] : model.rungs) rungs[rung] = share;
  for (const auto& [reason, count] : model.lost_images) lost[reason] = count;
  return {{"rig", model.rig},         {"uptime_s", model.uptime_s},
          {"missing", model.missing}, {"services", services},
          {"rings", rings},           {"rungs", rungs},
          {"lost_images", lost}};
}

}  // namespace handcast::supervisor
