// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/log.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <string>

#include "ipc/base/clock.hpp"

namespace handcast {

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f)
      shown += fmt::format("\\x{:02x}", byte);
    else
      shown += c;
  }
  return shown;
}

}  // namespace handcast

namespace handcast::log {
namespace {

constexpr std::array<std::string_view, 4> kNames{"debug", "info", "warning", "error"};

Level level_from_environment() {
  const char* wanted = std::getenv("HANDCAST_LOG");
  for (std::size_t i = 0; wanted && i < kNames.size(); ++i)
    if (kNames[i] == wanted) return static_cast<Level>(i);
  return Level::info;
}

std::string& program() {
  static std::string name = "handcast";
  return name;
}

std::atomic<Level>& threshold() {
  static std::atomic<Level> level{level_from_environment()};
  return level;
}

}  // namespace

void set_program(std::string_view name) { program() = name; }
void set_level(Level level) { threshold() = level; }

void write(Level level, std::string_view line) {
  if (level < threshold().load(std::memory_order_relaxed)) return;
  const auto text = fmt::format("{:.3f} {:<10} {:<7} {}\n", ns_to_seconds(now_ns()), program(),
                                kNames[static_cast<std::size_t>(level)], printable(line));
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace handcast::log
