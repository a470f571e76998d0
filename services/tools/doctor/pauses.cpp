// SPDX-License-Identifier: Apache-2.0
#include "services/tools/doctor/pauses.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <thread>

#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::doctor {
namespace {

constexpr std::int64_t kRun_ns = 1'000'000'000;
constexpr double kBusy = 0.8;  ///< share of a period; a loop without sleep would be throttled
constexpr std::uint64_t kOften = 10;  ///< interrupts in a second that are worth moving
constexpr double kMuch = 0.2;         ///< a pause of this share of a period makes frames late

std::string all_of(const char* file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool is_number(std::string_view text) {
  return !text.empty() &&
         std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Those of `now` that were counted since `before`.
Interrupts since(const Interrupts& before, Interrupts now) {
  for (auto& [key, line] : now.lines)
    if (const auto old = before.lines.find(key); old != before.lines.end())
      line.count -= std::min(line.count, old->second.count);
  std::erase_if(now.lines, [](const auto& entry) { return entry.second.count == 0; });
  return now;
}

/// The core on which the loop runs, and its priority, for the calling thread.
void settle(const config::Process& process, Pauses& pauses) {
  pauses.core =
      process.cores.empty() ? std::max(sched_getcpu(), 0) : static_cast<int>(process.cores.front());
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(pauses.core, &cores);
  if (pthread_setaffinity_np(pthread_self(), sizeof cores, &cores) != 0)
    pauses.core = std::max(sched_getcpu(), 0);
  const sched_param wanted{.sched_priority = process.priority};
  if (process.priority == 0) return;
  pauses.is_denied = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) != 0;
  if (!pauses.is_denied) pauses.priority = process.priority;
}

/// The longest pause of a frame that begins at `begin_ns`, us.
double longest_us(std::int64_t begin_ns, std::int64_t end_ns) {
  sleep_until_ns(begin_ns);
  std::int64_t last_ns = begin_ns, longest_ns = 0;
  do {
    const std::int64_t time_ns = now_ns();
    longest_ns = std::max(longest_ns, time_ns - last_ns);
    last_ns = time_ns;
  } while (last_ns < end_ns);
  return ns_to_us(longest_ns);
}

void run_loop(const config::Rig& rig, Pauses& pauses) {
  settle(config::process_of(rig, "projector"), pauses);
  const auto period_ns = std::max<std::int64_t>(seconds_to_ns(1 / rig.projector.rate_hz), 100'000);
  const auto busy_ns = static_cast<std::int64_t>(kBusy * static_cast<double>(period_ns));
  std::vector<double> longest;
  longest.reserve(static_cast<std::size_t>(kRun_ns / period_ns) + 1);
  const auto before = interrupts_in(all_of("/proc/interrupts"), pauses.core);
  const std::int64_t start_ns = now_ns(), end_ns = start_ns + kRun_ns;
  for (std::int64_t begin_ns = start_ns; begin_ns < end_ns;) {
    longest.push_back(longest_us(begin_ns, begin_ns + busy_ns));
    begin_ns += std::max<std::int64_t>((now_ns() - begin_ns) / period_ns + 1, 1) * period_ns;
  }
  pauses.interrupts = since(before, interrupts_in(all_of("/proc/interrupts"), pauses.core));
  pauses.period_us = ns_to_us(period_ns);
  pauses.frames = longest.size();
  pauses.longest_us = *std::ranges::max_element(longest);
  pauses.p99_us = quantile(std::move(longest), 0.99);
}

/// "eno1 (1200, IRQ 24), Local timer interrupts (250)": the three most frequent ones.
std::string describe(const Interrupts& interrupts) {
  std::vector<std::pair<std::string, Interrupts::Line>> lines(interrupts.lines.begin(),
                                                              interrupts.lines.end());
  std::ranges::stable_sort(lines, std::greater<>(),
                           [](const auto& entry) { return entry.second.count; });
  if (lines.size() > 3) lines.resize(3);
  std::vector<std::string> parts;
  for (const auto& [key, line] : lines)
    parts.push_back(fmt::format("{} ({}{})", line.name.empty() ? key : line.name, line.count,
                                is_number(key) ? ", IRQ " + key : ""));
  return join(parts, ", ");
}

/// What to do about pauses on a core.
std::string remedy_of(const Pauses& pauses) {
  std::vector<std::string> steps;
  if (pauses.priority == 0)
    steps.push_back(pauses.is_denied ? "permit the priority (see real time)"
                                     : "set projector.process.priority = 50");
  std::vector<std::string> devices;
  for (const auto& [key, line] : pauses.interrupts.lines)
    if (is_number(key) && line.count >= kOften) devices.push_back(key);
  if (!devices.empty())
    steps.push_back(
        fmt::format("move the interrupts {} to another core: `echo CORE | sudo tee "
                    "/proc/irq/{}/smp_affinity_list`",
                    join(devices, ", "), devices.front()));
  const auto core = pauses.core == 0 ? "N" : fmt::format("{}", pauses.core);
  steps.push_back(
      fmt::format("keep other work away: projector.process.cores = [{0}] and "
                  "isolcpus={0} nohz_full={0} on the kernel's command line{1}",
                  core, pauses.core == 0 ? "; not core 0: Linux keeps it" : ""));
  return join(steps, "; ");
}

}  // namespace

Interrupts interrupts_in(std::string_view text, int core) {
  std::istringstream lines{std::string(text)};
  std::string line, word;
  std::getline(lines, line);
  std::istringstream heads(line);
  std::size_t cores = 0, column = 0;
  bool is_there = false;
  for (; heads >> word; ++cores)
    if (word == fmt::format("CPU{}", core)) {
      column = cores;
      is_there = true;
    }
  Interrupts interrupts;
  while (is_there && std::getline(lines, line)) {
    std::istringstream words(line);
    std::string key;
    if (!(words >> key) || !key.ends_with(':')) continue;
    key.pop_back();
    Interrupts::Line entry;
    bool is_whole = true;  // ERR and MIS have one count for all cores
    for (std::size_t i = 0; i < cores && is_whole; ++i) {
      std::uint64_t count = 0;
      is_whole = static_cast<bool>(words >> count);
      if (i == column) entry.count = count;
    }
    if (!is_whole) continue;
    // Of a device: the controller and its line, then the names.
    for (int skipped = 0; is_number(key) && skipped < 2; ++skipped) words >> word;
    while (words >> word) entry.name += (entry.name.empty() ? "" : " ") + word;
    interrupts.lines.emplace(key, entry);
  }
  return interrupts;
}

Pauses measure_pauses(const config::Rig& rig) {
  Pauses pauses;
  std::thread([&] { run_loop(rig, pauses); }).join();
  return pauses;
}

Finding judge_pauses(const Pauses& pauses) {
  const auto how = pauses.priority > 0 ? fmt::format("priority {}", pauses.priority)
                                       : std::string("normal priority");
  auto sentence = fmt::format(
      "a loop like the projector's, on core {} at {}: the longest pause of {} frames was {:.0f} "
      "us, "
      "in 99 % at most {:.0f} us, of {:.0f} us a frame",
      pauses.core, how, pauses.frames, pauses.longest_us, pauses.p99_us, pauses.period_us);
  if (const auto interrupts = describe(pauses.interrupts); !interrupts.empty())
    sentence += "; interrupts there: " + interrupts;
  if (pauses.longest_us < kMuch * pauses.period_us) return {"pauses", Grade::good, sentence, ""};
  return {"pauses", Grade::advice, sentence, remedy_of(pauses)};
}

std::vector<Finding> examine_pauses(const config::Rig& rig, Asking asking) {
  if (asking == Asking::not_now) return {};
  return {judge_pauses(measure_pauses(rig))};
}

}  // namespace handcast::doctor
