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

// Services publish stage marks for each message, so the rates of the rings are counted from the
// marks.
json ring_status(const Service& service, const RigView& rig) {
  const auto& frames = rig.recorder.ledger().frames(service.spec().name);
  return {{"wanted_hz", wanted_hz(service.spec())},
          {"held_hz", rounded(frames.recent_hz(rig.now_ns))},
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

std::string text_of(const json& value, std::string_view unit = "") {
  if (value.is_null()) return "-";
  if (value.is_string()) return value.get<std::string>();
  return fmt::format("{:.6g}{}", value.get<double>(), unit);
}

/// "light: 59.9 Hz of 60 Hz; 3 refreshes without a new frame, ...". "" if none came.
std::string print_light(const json& status) {
  const auto light = status.value("light", json());
  if (light.is_null()) return "";
  const auto ring = status["rings"].value("projection.frames", json::object());
  return fmt::format(
      "\nlight: {} of {}; {} refreshes without a new frame, {} frames shown for several refreshes; "
      "times by the {}\n",
      text_of(ring.value("held_hz", json()), " Hz"),
      text_of(ring.value("wanted_hz", json()), " Hz"), light["missed_refreshes"].dump(),
      light["doubled_frames"].dump(), text_of(light["times_by"]));
}

/// "camera: 3 images never arrived, ...". "" if none was lost.
std::string print_losses(const json& status) {
  const auto lost = status.value("lost_images", json::object());
  const auto count = [&](const char* reason) { return lost.value(reason, std::uint64_t{0}); };
  if (count("missing") + count("incomplete") + count("underrun") + count("skipped") == 0) return "";
  return fmt::format(
      "\ncamera: {} images never arrived, {} were incomplete, {} found no free buffer, {} were "
      "skipped for a newer one\n",
      count("missing"), count("incomplete"), count("underrun"), count("skipped"));
}

/// "tracker: frozen 2 times, late 1 time". "" if it did nothing wrong.
std::string print_faults(const json& status) {
  const auto faults = status.value("tracker_faults", json::object());
  std::string text;
  for (const auto& [kind, count] : faults.items()) {
    if (!count.is_number_unsigned() || count == 0) continue;
    const auto times = count.get<std::uint64_t>();
    text += fmt::format("{}{} {} time{}", text.empty() ? "\ntracker: " : ", ", kind, times,
                        times == 1 ? "" : "s");
  }
  return text.empty() ? text : text + "\n";
}

/// Whether the tracker is where the calibration says. "" if nothing is known.
std::string print_drift(const json& status) {
  const auto drift = status.value("tracker_drift", json());
  if (!drift.is_object()) return "";
  const auto off = fmt::format("{} mm and {} degrees", text_of(drift.value("across_mm", json())),
                               text_of(drift.value("turn_deg", json())));
  if (!drift.value("moved", false))
    return fmt::format(
        "\ntracker: where the calibration says, as far as {} places of still hands "
        "tell ({})\n",
        text_of(drift.value("places", json())), off);
  return fmt::format(
      "\ntracker: it has moved by {} since the calibration; fasten it, then `handcast calibrate "
      "RIG.toml --correct` corrects the calibration\n",
      off);
}

/// The trouble of a service: "died 10 times within 60 s; tried again in 4.2 s". "" if it has none.
std::string print_trouble(const json& service) {
  std::string text =
      service.contains("reason") && !service["reason"].is_null() ? text_of(service["reason"]) : "";
  if (!service.contains("retry_s") || service["retry_s"].is_null()) return text;
  return text + fmt::format("{}tried again in {}", text.empty() ? "" : "; ",
                            text_of(service["retry_s"], " s"));
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

std::string print_status(const json& status) {
  auto text =
      fmt::format("rig {}, up {}\n\n", text_of(status["rig"]), text_of(status["uptime_s"], " s"));
  if (status.value("keeper_died", false))
    text +=
        "the keeper has died, so a dead supervisor would not be replaced; `handcast up` with the "
        "same arguments starts another keeper\n\n";
  text += fmt::format("{:<12} {:<10} {:>8} {:<10} {:>10} {:>8}  {}\n", "service", "state", "pid",
                      "back end", "up", "restarts", "last exit");
  for (const auto& [name, service] : status["services"].items()) {
    text += fmt::format("{:<12} {:<10} {:>8} {:<10} {:>10} {:>8}  {}\n", name,
                        text_of(service["state"]), text_of(service["pid"]),
                        text_of(service["backend"]), text_of(service["uptime_s"], " s"),
                        text_of(service["restarts"]), text_of(service["last_exit"]));
    if (const auto trouble = print_trouble(service); !trouble.empty())
      text += fmt::format("  {}\n", trouble);
    if (const auto asked = service.value("instead_of", json()); !asked.is_null())
      text += fmt::format("  in place of '{}', a file of which is missing\n", text_of(asked));
    if (!service.contains("log")) continue;
    for (const auto& line : service["log"]) text += fmt::format("    {}\n", text_of(line));
  }
  text += fmt::format("\n{:<20} {:>12} {:>12} {:>12} {:>10}\n", "ring", "wanted", "held",
                      "newest age", "messages");
  for (const auto& [name, ring] : status["rings"].items())
    text += fmt::format("{:<20} {:>12} {:>12} {:>12} {:>10}\n", name,
                        text_of(ring["wanted_hz"], " Hz"), text_of(ring["held_hz"], " Hz"),
                        text_of(ring["newest_age_ms"], " ms"), text_of(ring["count"]));
  text += print_light(status);
  text += print_losses(status);
  text += print_faults(status);
  text += print_drift(status);
  text +=
      fmt::format("\n{:<12} {:>12} {:>12} {:>10}   last 10 s\n", "stage", "p50", "p99", "count");
  for (const auto& [stage, times] : status["stage_us"].items())
    text += fmt::format("{:<12} {:>12} {:>12} {:>10}\n", stage, text_of(times["p50"], " us"),
                        text_of(times["p99"], " us"), text_of(times["count"]));
  return text;
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
                                     {"backend", backend_of(*service, rig)}};
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
