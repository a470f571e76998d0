// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace handcast::supervisor {
namespace {

constexpr std::string_view kClearLine = "\r\x1b[K";

void put(std::string_view text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

bool has_terminal() {
  static const bool terminal = isatty(STDERR_FILENO) == 1;
  return terminal;
}

void print_line(std::string_view line) {
  put(fmt::format("{}{}\n", has_terminal() ? kClearLine : "", line));
}

void show_progress(std::string_view line) {
  if (has_terminal())
    put(fmt::format("{}{}\r", kClearLine, line));  // the next output overwrites this line
  else
    print_line(line);
}

}  // namespace handcast::supervisor
