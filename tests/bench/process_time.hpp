// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace handcast::bench {

/// The processor time that a process has used, s.
inline double busy_seconds(pid_t pid) {
  std::ifstream stat(fmt::format("/proc/{}/stat", pid));
  std::string text;
  std::getline(stat, text);
  const auto fields = text.substr(text.rfind(')') + 2);
  long ticks = 0;
  std::size_t at = 0;
  for (int field = 3; field <= 15 && at != fields.npos; ++field) {
    const auto next = fields.find(' ', at);
    if (field >= 14) ticks += std::stol(fields.substr(at, next - at));
    at = next == fields.npos ? next : next + 1;
  }
  return static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace handcast::bench
