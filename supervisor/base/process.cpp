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

// "PID (name) state ppid ...": the name may contain any characters, so fields are counted after it.
// The state is field 3.
std::optional<std::uint64_t> start_ticks_of(pid_t pid) {
  constexpr int kStartField = 22;
  std::ifstream file(fmt::format("/proc/{}/stat", pid));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto behind_name = text.rfind(") ");
  if (behind_name == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(behind_name + 2));
  std::string field;
  for (int number = 3; number <= kStartField; ++number) {
    if (!(fields >> field)) return std::nullopt;
    if (number == 3 && (field == "Z" || field == "X")) return std::nullopt;
  }
  return std::strtoull(field.c_str(), nullptr, 10);
}

std::int64_t start_ns_of(std::uint64_t ticks) {
  timespec since_boot{};
  clock_gettime(CLOCK_BOOTTIME, &since_boot);
  const auto started_ns = static_cast<std::int64_t>(ticks) * (1'000'000'000 / sysconf(_SC_CLK_TCK));
  return now_ns() - (since_boot.tv_sec * 1'000'000'000 + since_boot.tv_nsec - started_ns);
}

}  // namespace handcast::supervisor
