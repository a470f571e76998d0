// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

constexpr std::size_t kLastWords = 5;

double rounded(double value) { return std::round(value * 100) / 100; }
json or_null(std::optional<double> value) { return value ? json(rounded(*value)) : json(); }

json wanted_hz(const ServiceSpec& spec) {
  const bool known =
      spec.wanted_hz > 0 && (spec.wanted_of.empty() || spec.wanted_of == spec.backend);
  return known ? json(spec.wanted_hz) : json();
}

bool is_well(const Service& service) {
  return service.state() == State::ready || service.state() == State::stopped;
}

/// Why a service is not well; null if it is.
json reason_of(const Service& service) {
  switch (service.state()) {
    case State::degraded:
      return fmt::format("died {} times within {:g} s", service.recent_deaths(),
                         ns_to_seconds(kStormWindow_ns));
    case State::failed:
      return service.log().last_sentence().empty() ? "cannot start" : service.log().last_sentence();
    default:
      return {};
  }
}

bool is_on_fallback(const Service& service, const RigView& rig) {
  const auto& spec = service.spec();
  return rig.recorder.ledger().detector(spec.name).is_fallback && !spec.fallback.empty() &&
         spec.backend != spec.fallback;
}

/// The back end that runs.
const std::string& backend_of(const Service& service, const RigView& rig) {
  return is_on_fallback(service, rig) ? service.spec().fallback : service.spec().backend;
}

json service_status(const Service& service, const RigView& rig) {
  const auto& exit = service.last_exit();
  json status{{"state", name_of(service.state())},
              {"pid", service.pid()},
              {"standby", service.spare_pid() != 0 ? json(service.spare_pid()) : json()},
              {"backend", backend_of(service, rig)},
              {"instead_of", is_on_fallback(service, rig) ? json(service.spec().backend) : json()},
              {"uptime_s", rounded(service.uptime_s(rig.now_ns))},
              {"restarts", service.restarts()},
              {"last_exit", exit ? json(exit->describe()) : json()},
              {"reason", reason_of(service)},
              {"retry_s", or_null(service.retry_s(rig.now_ns))},
              {"silent_ms", or_null(rig.recorder.silence_ms(service.spec().name, rig.now_ns))}};
  if (!is_well(service)) status["log"] = service.log().last(kLastWords);
  return status;
}

/// False if less than the wanted rate is no fault: the service plays a recording at its own times,
/// or draws once for several sub-frames.
bool is_held_to_its_rate(const ServiceSpec& spec) {
  return spec.backend != "replay" && !spec.counts_sub_frames;
}

/// False if the service is not well or so new that its held rate, a mean of some seconds, is not
/// yet its own.
bool is_settled(const Service& service, std::int64_t now_ns) {
  constexpr double kSettled_s = 10;
  return service.state() == State::ready && service.uptime_s(now_ns) >= kSettled_s;
}

// Services publish stage marks for each message, so the rates of the rings are counted from the
// marks.
json ring_status(const Service& service, const RigView& rig) {
  const auto& frames = rig.recorder.ledger().frames(service.spec().name);
  return {{"wanted_hz", wanted_hz(service.spec())},
          {"held_hz", rounded(frames.recent_hz(rig.now_ns))},
          {"is_held_to_it", is_held_to_its_rate(service.spec())},
          {"is_settled", is_settled(service, rig.now_ns)},
          {"count", frames.total()},
          {"newest_age_ms", or_null(frames.newest_age_ms(rig.now_ns))}};
}

/// The light of the output; null if none came.
json light_status(const LightCount& light) {
  if (!light.source) return {};
  return {{"times_by", msg::kLightSourceNames[static_cast<std::size_t>(*light.source)]},
          {"missed_refreshes", light.missed},
          {"doubled_frames", light.doubled}};
}

json loss_status(const LossCount& lost) {
  json status;
  for (const auto& [reason, count] : lost.by_reason()) status[std::string(reason)] = count;
  return status;
}

/// "frozen": 2, ... by kind.
json fault_status(const Ledger& ledger) {
  json status;
  for (std::size_t k = 0; k < msg::kTrackerFaults; ++k)
    status[std::string(msg::kTrackerFaultNames[k])] = ledger.tracker_faults()[k];
  return status;
}

/// Where the tracker seems to be, relative to its calibration; null if nothing is known.
json drift_status(const msg::DriftNote& drift) {
  if (drift.places == 0) return {};
  return {{"moved", drift.moved},
          {"places", drift.places},
          {"across_mm", rounded(drift.across_mm)},
          {"turn_deg", rounded(drift.turn_deg)}};
}

json summary_of(const Histogram& times) {
  return {{"p50", rounded(times.percentile_ns(0.50) * 1e-3)},
          {"p99", rounded(times.percentile_ns(0.99) * 1e-3)},
          {"count", times.count()}};
}

int restarts_of(const Services& services) {
  int sum = 0;
  for (const auto& service : services) sum += service->restarts();
  return sum;
}

}  // namespace

json status_of(const RigView& rig) {
  json status{{"rig", rig.name},
              {"uptime_s", rounded(ns_to_seconds(rig.now_ns - rig.started_ns))},
              {"keeper_died", rig.keeper_died}};
  for (const auto& service : rig.services) {
    status["services"][service->spec().name] = service_status(*service, rig);
    if (!service->spec().stream.empty())
      status["rings"][service->spec().stream] = ring_status(*service, rig);
  }
  status["light"] = light_status(rig.recorder.ledger().light());
  status["lost_images"] = loss_status(rig.recorder.ledger().lost_images());
  status["tracker_faults"] = fault_status(rig.recorder.ledger());
  status["tracker_drift"] = drift_status(rig.recorder.ledger().tracker_drift());
  status["stage_us"] = json::object();
  for (const auto& [stage, times] : rig.recorder.ledger().stages())
    status["stage_us"][stage] = summary_of(times.recent(rig.now_ns));
  for (std::size_t r = 0; r < msg::kRungs; ++r)
    status["rungs"][std::string(msg::kRungNames[r])] = rig.recorder.ledger().rungs()[r];
  return status;
}

std::string progress_line(const RigView& rig) {
  auto line = fmt::format("up {:.0f} s", ns_to_seconds(rig.now_ns - rig.started_ns));
  for (const auto& service : rig.services) {
    if (service->spec().stream.empty()) continue;
    line += fmt::format("  {} {:.0f} Hz", service->spec().name,
                        rig.recorder.ledger().frames(service->spec().name).recent_hz(rig.now_ns));
  }
  return line + fmt::format("  restarts {}", restarts_of(rig.services));
}

json live_report(const RigView& rig) {
  json report{{"rig", rig.name}, {"seconds", rounded(ns_to_seconds(rig.now_ns - rig.started_ns))}};
  for (const auto& service : rig.services) {
    const auto& spec = service->spec();
    report["services"][spec.name] = {{"restarts", service->restarts()},
                                     {"backend", backend_of(*service, rig)},
                                     {"is_held_to_its_rate", is_held_to_its_rate(spec)}};
    if (spec.stream.empty()) continue;
    const auto held_hz = rig.recorder.ledger().frames(spec.name).held_hz(rig.now_ns);
    report["rates"][spec.name] = {{"wanted_hz", wanted_hz(spec)}, {"held_hz", rounded(held_hz)}};
  }
  report["light"] = light_status(rig.recorder.ledger().light());
  report["lost_images"] = loss_status(rig.recorder.ledger().lost_images());
  report["tracker_faults"] = fault_status(rig.recorder.ledger());
  report["stage_us"] = json::object();
  for (const auto& [stage, times] : rig.recorder.ledger().stages())
    report["stage_us"][stage] = summary_of(times.whole_run());
  return report;
}

}  // namespace handcast::supervisor
