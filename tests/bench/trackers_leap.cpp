// SPDX-License-Identifier: Apache-2.0
// The driver of Leap Motion Controllers on an emulated one, of full size and rate.
//   bench_trackers_leap [--goals FILE] [--seconds N] [--faults N] [--priority N]
// The captures, and the emulation, which stands for hardware, have the real-time priority that
// docs/operating/cameras.md recommends for the camera's service, if it is permitted; 0: none.
#include <fmt/format.h>
#include <malloc.h>
#include <sched.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string_view>

#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/trackers_leap_watch.hpp"
#include "tests/emulation/under_umockdev.hpp"

namespace handcast::bench {
namespace {

using test::LeapFault;
using test::LeapModel;

/// What a machine with other work to do may be late.
constexpr double kLate_ms = 20;

/// Of this process.
struct Resources {
  double memory_mb = 0, descriptors = 0, threads = 0;
};

Resources resources() {
  Resources now;
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") status >> now.memory_mb;
    if (word == "Threads:") status >> now.threads;
  }
  now.memory_mb /= 1024;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    ++now.descriptors;
  return now;
}

void set_priority(int priority) {
  const sched_param parameters{.sched_priority = priority};
  const bool is_set =
      sched_setscheduler(0, priority > 0 ? SCHED_FIFO : SCHED_OTHER, &parameters) == 0;
  fmt::print("captures with {} priority\n",
             is_set && priority > 0 ? fmt::format("real-time ({})", priority) : "no real-time");
}

void stream(double seconds, std::vector<Goal>& goals) {
  WatchedLeap leap;
  if (!leap.open()) return;
  const auto begin_ns = now_ns();
  while (now_ns() < begin_ns + seconds_to_ns(seconds)) leap.capture();
  const double took_s = ns_to_seconds(now_ns() - begin_ns);
  const auto& seen = leap.seen();
  const auto begun = leap.device().with_model([](const LeapModel& m) { return m.frames_begun(); });
  fmt::print(
      "{:.0f} s of 640x240 of both eyes at 115 Hz, emulated: {} images sent, {} delivered "
      "({:.1f}/s), {} lost ({} missing, {} torn, {} skipped)\n"
      "  from the time at which the last byte should be sent to the capture: p50 {:.2f} ms, p99 "
      "{:.2f} ms\n",
      took_s, begun, seen.images, static_cast<double>(seen.images) / took_s, seen.counted,
      seen.lost.missing, seen.lost.incomplete, seen.lost.skipped, median(seen.late_ms),
      percentile(seen.late_ms, 0.99));
  goals.push_back(
      {"Leap: images lost and not counted", static_cast<double>(seen.uncounted), 0, ""});
  goals.push_back({"Leap: damaged images delivered", static_cast<double>(seen.damaged), 0, ""});
}

/// Most faults damage an image; one in fifty is a hang, a device that is unplugged, or both.
void meet(WatchedLeap& leap, std::mt19937& random) {
  const auto draw = random() % 100;
  if (draw == 0) {
    leap.device().unplug();
    for (int i = 0; i < 5; ++i) leap.capture();
    leap.device().plug_in();
  } else if (draw == 1) {
    leap.device().with_model([](LeapModel& model) { model.inject(LeapFault::hang); });
  } else {
    constexpr std::array kFaults{LeapFault::stall,         LeapFault::transfer_error,
                                 LeapFault::short_payload, LeapFault::garbage_header,
                                 LeapFault::error_bit,     LeapFault::lost_payload,
                                 LeapFault::lost_frame,    LeapFault::lost_end};
    leap.device().with_model(
        [&](LeapModel& model) { model.inject(kFaults[draw % kFaults.size()]); });
  }
}

void break_it(int faults, std::vector<Goal>& goals) {
  WatchedLeap leap;
  if (!leap.open()) return;
  std::mt19937 random(1);
  Resources early;
  for (int i = 0; i < faults; ++i) {
    if (i == faults / 5) early = resources();
    meet(leap, random);
    for (int k = 0; k < 3; ++k) leap.capture();
  }
  for (int i = 0; i < 100; ++i) leap.capture();
  malloc_trim(0);
  const auto late = resources();
  const auto& seen = leap.seen();
  const auto counts = leap.device().counts();
  fmt::print(
      "{} faults: {} images delivered, {} counted as lost ({} missing, {} torn), {} halts "
      "cleared, {} resets\n  memory {:.1f} -> {:.1f} MB, descriptors {} -> {}, threads {} -> {}\n",
      faults, seen.images, seen.counted, seen.lost.missing, seen.lost.incomplete,
      counts.halts_cleared, counts.resets, early.memory_mb, late.memory_mb, early.descriptors,
      late.descriptors, early.threads, late.threads);
  fmt::print(
      "  latest return after a deadline {:.1f} ms; without waiting for a processor {:.1f} ms\n",
      std::max(seen.latest_ms, 0.), std::max(seen.latest_own_ms, 0.));
  goals.push_back({"Leap, faults: the latest return after a deadline", std::max(seen.latest_ms, 0.),
                   kLate_ms, "ms"});
  goals.push_back(
      {"Leap, faults: images lost and not counted", static_cast<double>(seen.uncounted), 0, ""});
  goals.push_back(
      {"Leap, faults: damaged images delivered", static_cast<double>(seen.damaged), 0, ""});
  goals.push_back({"Leap, faults: growth of memory after the first fifth",
                   late.memory_mb - early.memory_mb, 2, "MB"});
  goals.push_back({"Leap, faults: more descriptors", late.descriptors - early.descriptors, 0, ""});
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  handcast::test::see_emulated_devices(argv);
  std::string goals_file;
  double seconds = 20;
  int faults = 1000, priority = 1;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view word = argv[i];
    if (word == "--goals") goals_file = argv[i + 1];
    if (word == "--seconds") seconds = std::atof(argv[i + 1]);
    if (word == "--faults") faults = std::atoi(argv[i + 1]);
    if (word == "--priority") priority = std::atoi(argv[i + 1]);
  }
  if (!handcast::test::sees_emulated_devices()) {
    fmt::print("leap: not measured, umockdev-wrapper is not installed\n");
    return 0;
  }
  std::vector<Goal> goals;
  set_priority(priority);
  stream(seconds, goals);
  break_it(faults, goals);
  print_goals(goals);
  if (goals_file.empty() || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_trackers_leap: cannot write '{}'.\n", goals_file);
  return 1;
}
