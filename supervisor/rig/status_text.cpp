// SPDX-License-Identifier: Apache-2.0
#include "supervisor/rig/status_text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>
#include <vector>

#include "ipc/base/join.hpp"

namespace handcast::supervisor {
namespace {

using nlohmann::json;

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
        "\ntracker: where the calibration says, as far as {} places of still hands tell ({})\n",
        text_of(drift.value("places", json())), off);
  return fmt::format(
      "\ntracker: it has moved by {} since the calibration; fasten it, then `handcast calibrate "
      "RIG.toml --correct` corrects the calibration\n",
      off);
}

/// "98.9 us", "2.34 ms".
std::string text_of_us(const json& value) {
  constexpr double kMs = 1000;
  if (!value.is_number() || value.get<double>() < kMs) return text_of(value, " us");
  return fmt::format("{:.2f} ms", value.get<double>() / kMs);
}

/// Names the rings that hold much less than their rate, and what to do. "" if none does.
std::string print_slow(const json& status) {
  constexpr double kEnough = 0.9;
  std::vector<std::string> slow;
  for (const auto& [name, ring] : status["rings"].items()) {
    const auto wanted = ring.value("wanted_hz", json()), held = ring.value("held_hz", json());
    const bool is_judged = ring.value("is_held_to_it", false) && ring.value("is_settled", false);
    if (is_judged && wanted.is_number() && held.is_number() &&
        held.get<double>() < kEnough * wanted.get<double>())
      slow.push_back(name);
  }
  if (slow.empty()) return "";
  return fmt::format(
      "\nslow: {} {} less than 90 % of the wanted rate; `handcast latency` shows where the "
      "time goes. On a computer that is too slow, lower camera.rate_hz and projector.rate_hz\n",
      join(slow, ", "), slow.size() == 1 ? "holds" : "hold");
}

/// The trouble of a service: "died 10 times within 60 s; tried again in 4.2 s". "" if it has none.
std::string print_trouble(const json& service) {
  std::string text =
      service.contains("reason") && !service["reason"].is_null() ? text_of(service["reason"]) : "";
  if (!service.contains("retry_s") || service["retry_s"].is_null()) return text;
  return text + fmt::format("{}tried again in {}", text.empty() ? "" : "; ",
                            text_of(service["retry_s"], " s"));
}

std::string print_services(const json& status) {
  auto text = fmt::format("{:<12} {:<10} {:>8} {:<10} {:>10} {:>8}  {}\n", "service", "state",
                          "pid", "back end", "up", "restarts", "last exit");
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
  return text;
}

std::string print_rings(const json& status) {
  auto text = fmt::format("\n{:<20} {:>12} {:>12} {:>12} {:>10}\n", "ring", "wanted", "held",
                          "newest age", "messages");
  for (const auto& [name, ring] : status["rings"].items())
    text += fmt::format("{:<20} {:>12} {:>12} {:>12} {:>10}\n", name,
                        text_of(ring["wanted_hz"], " Hz"), text_of(ring["held_hz"], " Hz"),
                        text_of(ring["newest_age_ms"], " ms"), text_of(ring["count"]));
  return text;
}

std::string print_stages(const json& status) {
  auto text =
      fmt::format("\n{:<12} {:>12} {:>12} {:>10}   last 10 s\n", "stage", "p50", "p99", "count");
  for (const auto& [stage, times] : status["stage_us"].items())
    text += fmt::format("{:<12} {:>12} {:>12} {:>10}\n", stage, text_of_us(times["p50"]),
                        text_of_us(times["p99"]), text_of(times["count"]));
  return text;
}

}  // namespace

std::string print_status(const json& status) {
  auto text =
      fmt::format("rig {}, up {}\n\n", text_of(status["rig"]), text_of(status["uptime_s"], " s"));
  if (status.value("keeper_died", false))
    text +=
        "the keeper has died, so a dead supervisor would not be replaced; `handcast up` with the "
        "same arguments starts another keeper\n\n";
  return text + print_services(status) + print_rings(status) + print_slow(status) +
         print_light(status) + print_losses(status) + print_faults(status) + print_drift(status) +
         print_stages(status);
}

}  // namespace handcast::supervisor
