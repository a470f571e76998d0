// SPDX-License-Identifier: Apache-2.0
// Commands to a DLP controller of which one in ten meets a fault, through the real hidapi.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <random>

#include "services/projector/dlp/link.hpp"
#include "tests/bench/devices.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/services/projector/dlp/emulated_controller.hpp"

namespace handcast::bench {
namespace {

using dlp::protocol::Command;
using dlp::protocol::Controller;
using test::Fault;

constexpr int kCommands = 10'000;
constexpr std::int64_t kDeadline_ns = 60'000'000;
/// What a machine with other work to do may be late.
constexpr double kLate_ms = 5;

/// What came of the commands that met one fault.
struct Outcome {
  int commands = 0, done = 0;
  std::vector<double> ms{};
};

const std::map<Fault, const char*> kNames{
    {Fault::none, "none"},
    {Fault::silence, "silence"},
    {Fault::lost_reply, "lost reply"},
    {Fault::refusal, "refusal"},
    {Fault::short_report, "short report"},
    {Fault::cut_reply, "cut reply"},
    {Fault::wrong_sequence, "wrong sequence"},
    {Fault::stray_first, "stray reply first"},
    {Fault::absurd_length, "absurd length"},
};

/// Silences last as long as the deadline, so there are fewer of them.
Fault draw_fault(std::mt19937& random) {
  const auto draw = random() % 1000;
  if (draw >= 100) return Fault::none;
  constexpr std::array kSlow{Fault::silence, Fault::lost_reply, Fault::wrong_sequence};
  constexpr std::array kQuick{Fault::refusal, Fault::short_report, Fault::cut_reply,
                              Fault::stray_first, Fault::absurd_length};
  return draw < 6 ? kSlow[draw % kSlow.size()] : kQuick[draw % kQuick.size()];
}

bool send(dlp::Link& link, bool reads, Deadline deadline) {
  if (reads) return link.read(Command::hardware_status, 1, deadline).has_value();
  const std::array<std::uint8_t, 1> off{0};
  return link.write(Command::led_enables, off, deadline).has_value();
}

void print(const std::map<Fault, Outcome>& outcomes) {
  fmt::print(
      "{} commands to an emulated DLPC900, deadline {:.0f} ms each\n  {:<18} {:>8} {:>8} "
      "{:>8} {:>8} {:>8}\n",
      kCommands, ns_to_ms(kDeadline_ns), "fault", "commands", "done", "p50 ms", "p99 ms", "max ms");
  for (const auto& [fault, outcome] : outcomes)
    fmt::print("  {:<18} {:8} {:8} {:8.2f} {:8.2f} {:8.2f}\n", kNames.at(fault), outcome.commands,
               outcome.done, median(outcome.ms), percentile(outcome.ms, 0.99),
               percentile(outcome.ms, 1));
}

}  // namespace

void measure_hid(std::vector<Goal>& goals) {
  if (!test::sees_emulated_devices())
    return fmt::print("hid: not measured, umockdev-wrapper is not installed\n");
  test::EmulatedController device(Controller::dlpc900);
  const auto found = dlp::list_hid_devices(0x0451);
  auto opened = dlp::HidDevice::open(found.at(0));
  if (!opened) return fmt::print("hid: not measured: {}\n", opened.error().what);
  dlp::Link link(std::move(*opened), Controller::dlpc900);
  std::mt19937 random(1);
  std::map<Fault, Outcome> outcomes;
  double latest_ms = 0;
  for (int i = 0; i < kCommands; ++i) {
    const auto fault = draw_fault(random);
    device.inject({fault});
    const auto deadline = Deadline::in(std::chrono::nanoseconds(kDeadline_ns));
    bool done = false;
    const double took_ms = timed_us([&] { done = send(link, i % 2 == 0, deadline); }) / 1e3;
    auto& outcome = outcomes[fault];
    ++outcome.commands;
    outcome.done += done;
    outcome.ms.push_back(took_ms);
    latest_ms = std::max(latest_ms, took_ms - ns_to_ms(kDeadline_ns));
  }
  print(outcomes);
  goals.push_back(
      {"HID: the latest return after a deadline", std::max(latest_ms, 0.0), kLate_ms, "ms"});
  goals.push_back({"HID: commands without a fault that failed",
                   static_cast<double>(outcomes[Fault::none].commands - outcomes[Fault::none].done),
                   0, ""});
  goals.push_back({"HID: reports that the controller could not accept",
                   static_cast<double>(device.complaints().size()), 0, ""});
}

}  // namespace handcast::bench
