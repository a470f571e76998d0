// SPDX-License-Identifier: Apache-2.0
#include "services/tools/page/machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string_view>
#include <thread>

namespace handcast::page {

static std::string first_line_after(const char* file, std::string_view key, char separator) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(key, 0) != 0) continue;
    line.erase(0, line.find(separator) + 1);
    line.erase(0, line.find_first_not_of(" \t\""));
    line.erase(line.find_last_not_of(" \t\"") + 1);
    return line;
  }
  return "";
}

std::string this_machine() {
  std::string machine = first_line_after("/proc/cpuinfo", "model name", ':');
  if (machine.empty()) machine = "unknown processor";
  const unsigned cores = std::thread::hardware_concurrency();
  machine += fmt::format(", {} core{}", cores, cores == 1 ? "" : "s");
  const std::string system = first_line_after("/etc/os-release", "PRETTY_NAME", '=');
  return system.empty() ? machine : machine + ", " + system;
}

}  // namespace handcast::page
