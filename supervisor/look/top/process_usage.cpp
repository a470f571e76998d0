// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/process_usage.hpp"

#include <fmt/format.h>
#include <sched.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <vector>

#include "ipc/base/clock.hpp"
#include "supervisor/base/process.hpp"

namespace handcast::supervisor {
namespace {

std::vector<std::int64_t> numbers_in(std::string_view text) {
  std::vector<std::int64_t> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    std::int64_t number = 0;
    const auto [after, error] = std::from_chars(at, end, number);
    // Added as 0 if it is out of range, so that later fields keep their places.
    if (after != at) numbers.push_back(number);
    at = after != at ? after : at + 1;
  }
  return numbers;
}

int descriptors_in(const std::filesystem::path& folder) {
  std::error_code forbidden;
  int count = 0;
  for (std::filesystem::directory_iterator entry(folder, forbidden), end;
       !forbidden && entry != end; entry.increment(forbidden))
    ++count;
  return forbidden ? -1 : count;
}

/// The processor time, in nanoseconds and not in the ticks of 10 ms of /proc/PID/stat.
std::optional<std::int64_t> cpu_time_of(pid_t pid) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &time) != 0)
    return std::nullopt;
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

// The fields of proc(5). The name is in parentheses and may contain any characters, also these.
bool read_stat(std::string_view text, std::int64_t ticks_per_second, ProcessUsage& usage) {
  const auto open = text.find('('), close = text.rfind(')');
  if (open == std::string_view::npos || close == std::string_view::npos || close < open ||
      text.size() < close + 4)
    return false;
  const char state = text[close + 2];
  const auto fields = numbers_in(text.substr(close + 4));  // starts with field 4
  const auto field = [&](std::size_t number) { return fields[number - 4]; };
  if (fields.size() < 41 - 3 || ticks_per_second <= 0 || state == 'Z' || state == 'X') return false;

  usage.program = text.substr(open + 1, close - open - 1);
  usage.cpu_ns = (field(14) + field(15)) * (1'000'000'000 / ticks_per_second);
  usage.nice = static_cast<int>(field(19));
  usage.threads = static_cast<int>(field(20));
  usage.started_ticks = static_cast<std::uint64_t>(field(22));
  usage.last_core = static_cast<int>(field(39));
  usage.priority = static_cast<int>(field(40));
  usage.policy = static_cast<int>(field(41));
  return true;
}

bool read_statm(std::string_view text, std::int64_t page_bytes, ProcessUsage& usage) {
  const auto pages = numbers_in(text);
  if (pages.size() < 3) return false;
  usage.resident_bytes = pages[1] * page_bytes;
  usage.shared_bytes = std::min(pages[2], pages[1]) * page_bytes;
  return true;
}

std::optional<ProcessUsage> usage_of(pid_t pid) {
  if (pid <= 0) return std::nullopt;
  const auto folder = std::filesystem::path("/proc") / std::to_string(pid);
  ProcessUsage usage;
  if (!read_stat(proc_text(folder / "stat"), sysconf(_SC_CLK_TCK), usage)) return std::nullopt;
  if (!read_statm(proc_text(folder / "statm"), sysconf(_SC_PAGESIZE), usage)) return std::nullopt;
  usage.descriptors = descriptors_in(folder / "fd");
  usage.cpu_ns = cpu_time_of(pid).value_or(usage.cpu_ns);
  usage.taken_ns = now_ns();
  return usage;
}

std::optional<double> cores_used(const ProcessUsage& before, const ProcessUsage& now) {
  const auto span_ns = now.taken_ns - before.taken_ns;
  if (before.started_ticks != now.started_ticks || span_ns <= 0 || now.cpu_ns < before.cpu_ns)
    return std::nullopt;
  return static_cast<double>(now.cpu_ns - before.cpu_ns) / static_cast<double>(span_ns);
}

std::string scheduling_of(const ProcessUsage& usage) {
  switch (usage.policy) {
    case SCHED_FIFO:
      return fmt::format("FIFO {}", usage.priority);
    case SCHED_RR:
      return fmt::format("RR {}", usage.priority);
    case SCHED_BATCH:
      return "batch";
    case SCHED_IDLE:
      return "idle";
    default:
      return usage.nice == 0 ? "" : fmt::format("nice {}", usage.nice);
  }
}

}  // namespace handcast::supervisor
