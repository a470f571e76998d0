// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <vector>

#include "ipc/base/join.hpp"
#include "supervisor/look/figures/figures.hpp"

namespace handcast::supervisor {
namespace {

std::string text_or_dash(const std::string& text) { return text.empty() ? "-" : text; }

std::string text_of(const std::optional<double>& value, std::string_view unit) {
  return value ? fmt::format("{:.6g}{}", *value, unit) : "-";
}

/// "light of projector: 3 refreshes without a new frame, ...", a line for each.
std::string print_lights(const Figures& figures) {
  std::string text;
  for (const auto& [projector, light] : figures.lights)
    text += fmt::format(
        "\nlight of {}: {} refreshes without a new frame, {} frames shown for several refreshes; "
        "times by the {}\n",
        projector, light.missed_refreshes, light.doubled_frames, light.times_by);
  return text;
}

/// "camera: 3 images never arrived, ...". "" if none was lost.
std::string print_losses(const std::map<std::string, std::uint64_t>& lost) {
  const auto count = [&](const char* reason) {
    const auto found = lost.find(reason);
    return found == lost.end() ? 0 : found->second;
  };
  if (count("missing") + count("incomplete") + count("underrun") + count("skipped") == 0) return "";
  return fmt::format(
      "\ncamera: {} images never arrived, {} were incomplete, {} found no free buffer, {} were "
      "skipped for a newer one\n",
      count("missing"), count("incomplete"), count("underrun"), count("skipped"));
}

/// "tracker: frozen 2 times, late 1 time". "" if it did nothing wrong.
std::string print_faults(const std::map<std::string, std::uint64_t>& faults) {
  std::vector<std::string> parts;
  for (const auto& [kind, count] : faults)
    if (count > 0) parts.push_back(fmt::format("{} {} time{}", kind, count, count == 1 ? "" : "s"));
  return parts.empty() ? "" : fmt::format("\ntracker: {}\n", join(parts, ", "));
}

/// Whether the tracker is where the calibration says. "" if nothing is known.
std::string print_drift(const std::optional<DriftFigures>& drift) {
  if (!drift) return "";
  const auto off = fmt::format("{:.6g} mm and {:.6g} degrees", drift->across_mm, drift->turn_deg);
  if (!drift->moved)
    return fmt::format(
        "\ntracker: where the calibration says, as far as {} places of still hands tell ({})\n",
        drift->places, off);
  return fmt::format(
      "\ntracker: it has moved by {} since the calibration; fasten it, then `handcast calibrate "
      "RIG.toml --correct` corrects the calibration\n",
      off);
}

/// How well the other computer's clock is known. "" if nothing comes from one.
std::string print_bridge(const std::optional<BridgeFigures>& bridge) {
  if (!bridge) return "";
  return fmt::format(
      "\nbridge: times of the other computer are known to {:.3f} ms; {} messages were not used\n",
      bridge->clock_error_us / 1000, bridge->refused);
}

/// "98.9 us", "2.34 ms".
std::string text_of_us(double us) {
  constexpr double kMs = 1000;
  return us < kMs ? fmt::format("{:.6g} us", us) : fmt::format("{:.2f} ms", us / kMs);
}

/// What made the slowest frames of each projector slow.
std::string print_slow_frames(const Figures& figures) {
  std::string text;
  for (const auto& [projector, slow] : figures.slow_frames)
    text += fmt::format(
        "\nslowest {} frames of {}, {} or more: {} preempted by other threads, {} interrupted, {} "
        "with page faults, {} slow by themselves\n",
        slow.count, projector, text_of_us(slow.least_us), slow.preempted, slow.interrupted,
        slow.page_faults, slow.own);
  return text;
}

/// Names the rings that hold much less than their rate, and what to do. "" if none does.
std::string print_slow(const Figures& figures) {
  std::vector<std::string> slow;
  for (const auto& [name, stream] : figures.streams)
    if (stream.slow()) slow.push_back(name);
  if (slow.empty()) return "";
  return fmt::format(
      "\nslow: {} {} less than 90 % of the wanted rate; `handcast latency` shows where the "
      "time goes. On a computer that is too slow, lower camera.rate_hz and projector.rate_hz\n",
      join(slow, ", "), slow.size() == 1 ? "holds" : "hold");
}

/// The trouble of a service: "died 10 times within 60 s; tried again in 4.2 s". "" if it has none.
std::string print_trouble(const ServiceFigures& service) {
  if (!service.retry_s) return service.reason;
  return fmt::format("{}{}tried again in {}", service.reason, service.reason.empty() ? "" : "; ",
                     text_of(service.retry_s, " s"));
}

std::string print_services(const Figures& figures) {
  constexpr const char* kRow = "{:<16} {:<10} {:>8} {:<10} {:>10} {:>8}  {}\n";
  auto text = fmt::format(fmt::runtime(kRow), "service", "state", "pid", "back end", "up",
                          "restarts", "last exit");
  for (const auto& [name, service] : figures.services) {
    text += fmt::format(fmt::runtime(kRow), name, service.state, service.pid, service.backend,
                        text_of(service.uptime_s, " s"), service.restarts,
                        text_or_dash(service.last_exit));
    if (const auto trouble = print_trouble(service); !trouble.empty())
      text += fmt::format("  {}\n", trouble);
    if (!service.instead_of.empty())
      text += fmt::format("  in place of '{}', a file of which is missing\n", service.instead_of);
    for (const auto& line : service.log) text += fmt::format("    {}\n", line);
  }
  return text;
}

std::string print_rings(const Figures& figures) {
  constexpr const char* kRow = "{:<20} {:>12} {:>12} {:>12} {:>10}\n";
  auto text =
      "\n" + fmt::format(fmt::runtime(kRow), "ring", "wanted", "held", "newest age", "messages");
  for (const auto& [name, ring] : figures.streams)
    text +=
        fmt::format(fmt::runtime(kRow), name, text_of(ring.wanted_hz, " Hz"),
                    text_of(ring.held_hz, " Hz"), text_of(ring.newest_age_ms, " ms"), ring.count);
  return text;
}

std::string print_stages(const Figures& figures) {
  constexpr const char* kRow = "{:<12} {:>12} {:>12} {:>10}{}\n";
  auto text =
      "\n" + fmt::format(fmt::runtime(kRow), "stage", "p50", "p99", "count", "   last 10 s");
  for (const auto& [stage, times] : figures.stages)
    text += fmt::format(fmt::runtime(kRow), stage, text_of_us(times.p50_us),
                        text_of_us(times.p99_us), times.count, "");
  return text;
}

}  // namespace

std::string print_status(const Figures& figures) {
  auto text = fmt::format("rig {}, up {:.6g} s\n\n", figures.rig, figures.uptime_s);
  if (figures.keeper_died)
    text +=
        "the keeper has died, so a dead supervisor would not be replaced; `handcast up` with the "
        "same arguments starts another keeper\n\n";
  return text + print_services(figures) + print_rings(figures) + print_slow(figures) +
         print_lights(figures) + print_slow_frames(figures) + print_losses(figures.lost_images) +
         print_faults(figures.tracker_faults) + print_drift(figures.tracker_drift) +
         print_bridge(figures.bridge) + print_stages(figures);
}

}  // namespace handcast::supervisor
