// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

constexpr std::size_t kLastWords = 5;

double rounded(double value) { return std::round(value * 100) / 100; }
std::optional<double> rounded(std::optional<double> value) {
  return value ? std::optional(rounded(*value)) : value;
}

std::optional<double> wanted_hz(const ServiceSpec& spec) {
  const bool known =
      spec.wanted_hz > 0 && (spec.wanted_of.empty() || spec.wanted_of == spec.backend);
  return known ? std::optional(rounded(spec.wanted_hz)) : std::nullopt;
}

bool is_well(const Service& service) {
  return service.state() == State::ready || service.state() == State::stopped;
}

/// Why a service is not well; "" if it is.
std::string reason_of(const Service& service) {
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

ServiceFigures figures_of(const Service& service, const RigView& rig) {
  const auto& exit = service.last_exit();
  ServiceFigures figures;
  figures.state = name_of(service.state());
  figures.backend = backend_of(service, rig);
  if (is_on_fallback(service, rig)) figures.instead_of = service.spec().backend;
  if (exit) figures.last_exit = exit->describe();
  figures.reason = reason_of(service);
  if (!is_well(service) || service.spec().shows_log) figures.log = service.log().last(kLastWords);
  figures.pid = service.pid();
  figures.standby_pid = service.standby_pid();
  figures.restarts = service.restarts();
  figures.uptime_s = rounded(service.uptime_s(rig.now_ns));
  figures.retry_s = rounded(service.retry_s(rig.now_ns));
  figures.silent_ms = rounded(rig.recorder.silence_ms(service.spec().name, rig.now_ns));
  return figures;
}

/// False if less than the wanted rate is no fault: the service plays a recording at its own times,
/// or draws once for several sub-frames.
bool is_held_to_its_rate(const ServiceSpec& spec) {
  return spec.backend != "replay" && !spec.counts_sub_frames;
}

/// False if it is not well, or so new that its held rate, a mean of seconds, is not yet its own.
bool is_settled(const Service& service, std::int64_t now_ns) {
  constexpr double kSettled_s = 10;
  return service.state() == State::ready && service.uptime_s(now_ns) >= kSettled_s;
}

// Each message has stage marks, from which the rates of the rings are counted.
StreamFigures stream_figures_of(const Service& service, const RigView& rig) {
  const auto& frames = rig.recorder.ledger().frames(service.spec().name);
  return {.wanted_hz = wanted_hz(service.spec()),
          .held_hz = rounded(frames.recent_hz(rig.now_ns)),
          .is_held_to_it = is_held_to_its_rate(service.spec()),
          .is_settled = is_settled(service, rig.now_ns),
          .count = frames.total(),
          .newest_age_ms = rounded(frames.newest_age_ms(rig.now_ns))};
}

LightFigures figures_of(const LightCount& light) {
  return {std::string(name_of(light.source)), light.missed, light.doubled};
}

SlowFrameFigures figures_of(const SlowFrames& slow) {
  const auto causes = slow.causes();
  return {slow.count(),     rounded(ns_to_us(slow.least_ns())),
          causes.preempted, causes.interrupted,
          causes.faulted,   causes.own};
}

/// Empty if nothing is known.
std::optional<DriftFigures> figures_of(const msg::DriftNote& drift) {
  if (drift.places == 0) return std::nullopt;
  return DriftFigures{drift.moved, static_cast<int>(drift.places), rounded(drift.across_mm),
                      rounded(drift.turn_deg)};
}

StageFigures figures_of(const Histogram& times) {
  return {rounded(times.percentile_ns(0.50) * 1e-3), rounded(times.percentile_ns(0.99) * 1e-3),
          times.count()};
}

int restarts_of(const Services& services) {
  int sum = 0;
  for (const auto& service : services) sum += service->restarts();
  return sum;
}

}  // namespace

Figures figures_of(const RigView& rig) {
  const auto& ledger = rig.recorder.ledger();
  Figures figures;
  figures.rig = rig.name;
  figures.uptime_s = rounded(ns_to_seconds(rig.now_ns - rig.started_ns));
  figures.keeper_died = rig.keeper_died;
  for (const auto& service : rig.services) {
    const auto& spec = service->spec();
    figures.services[spec.name] = figures_of(*service, rig);
    if (!spec.stream.empty()) figures.streams[spec.stream] = stream_figures_of(*service, rig);
  }
  for (const auto& [projector, light] : ledger.lights())
    figures.lights[projector] = figures_of(light);
  for (const auto& [projector, slow] : ledger.slow_frames())
    figures.slow_frames[projector] = figures_of(slow);
  for (const auto& [reason, count] : ledger.lost_images().by_reason())
    figures.lost_images[std::string(reason)] = count;
  for (std::size_t k = 0; k < msg::kTrackerFaults; ++k)
    figures.tracker_faults[std::string(msg::kTrackerFaultNames[k])] = ledger.tracker_faults()[k];
  figures.tracker_drift = figures_of(ledger.tracker_drift());
  if (const auto& note = ledger.bridge())
    figures.bridge = BridgeFigures{rounded(note->clock_error_us), note->refused};
  for (const auto& [stage, times] : ledger.stages())
    figures.stages[stage] = figures_of(times.recent(rig.now_ns));
  for (std::size_t r = 0; r < msg::kRungs; ++r)
    figures.rungs[std::string(msg::kRungNames[r])] = ledger.rungs()[r];
  return figures;
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
  auto figures = figures_of(rig);
  for (const auto& [stage, times] : rig.recorder.ledger().stages())
    figures.stages[stage] = figures_of(times.whole_run());
  const auto all = to_json(std::move(figures));
  json report{{"rig", all["rig"]}, {"seconds", all["uptime_s"]}};
  for (const auto* part : {"light", "slow_frames", "lost_images", "tracker_faults", "stage_us"})
    report[part] = all[part];
  for (const auto& service : rig.services) {
    const auto& spec = service->spec();
    report["services"][spec.name] = {{"restarts", service->restarts()},
                                     {"backend", backend_of(*service, rig)},
                                     {"is_held_to_its_rate", is_held_to_its_rate(spec)}};
    if (spec.stream.empty()) continue;
    const auto held_hz = rig.recorder.ledger().frames(spec.name).held_hz(rig.now_ns);
    report["rates"][spec.name] = {{"wanted_hz", all["rings"][spec.stream]["wanted_hz"]},
                                  {"held_hz", rounded(held_hz)}};
  }
  return report;
}

}  // namespace handcast::supervisor
