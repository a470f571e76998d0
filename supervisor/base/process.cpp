// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/process.hpp"

#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {

namespace {

constexpr int kStateField = 3, kParentField = 4, kStartField = 22;  // of /proc/PID/stat (proc(5))

/// A field from the third on. "PID (name) state ppid ...": the name may contain any characters, so
/// fields are counted after it. Empty if there is no such process, or only a zombie.
std::optional<std::string> stat_field(pid_t pid, int wanted) {
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto behind_name = text.rfind(") ");
  if (behind_name == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(behind_name + 2));
  std::string field;
  for (int number = kStateField; number <= wanted; ++number) {
    if (!(fields >> field)) return std::nullopt;
    if (number == kStateField && (field == "Z" || field == "X")) return std::nullopt;
  }
  return field;
}

}  // namespace

std::optional<std::uint64_t> start_ticks_of(pid_t pid) {
  const auto field = stat_field(pid, kStartField);
  return field ? std::optional(std::strtoull(field->c_str(), nullptr, 10)) : std::nullopt;
}

std::optional<pid_t> parent_of(pid_t pid) {
  const auto field = stat_field(pid, kParentField);
  return field ? std::optional(static_cast<pid_t>(std::strtol(field->c_str(), nullptr, 10)))
               : std::nullopt;
}

std::int64_t start_ns_of(std::uint64_t ticks) {
  timespec since_boot{};
  clock_gettime(CLOCK_BOOTTIME, &since_boot);
  const auto started_ns = static_cast<std::int64_t>(ticks) * (1'000'000'000 / sysconf(_SC_CLK_TCK));
  return now_ns() - (since_boot.tv_sec * 1'000'000'000 + since_boot.tv_nsec - started_ns);
}

}  // namespace handcast::supervisor
