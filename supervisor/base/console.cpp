// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::supervisor {
namespace {

constexpr std::string_view kClearLine = "\r\x1b[K";

/// Lines of services have a level. Other lines that begin with the name of a program are errors.
log::Level level_of(std::string_view line) {
  if (const auto logged = log::parse(line)) return logged->level;
  return line.starts_with("handcast: ") ? log::Level::error : log::Level::info;
}

}  // namespace

bool has_terminal() {
  static const bool terminal = inherited::is_terminal(STDERR_FILENO);
  return terminal;
}

void print_line(std::string_view line) {
  log::put(log::for_journal(level_of(line), fmt::format("{}{}\n", has_terminal() ? kClearLine : "",
                                                        shown_line(line, line.size()))));
}

void show_progress(std::string_view line) {
  log::put(fmt::format("{}{}\r", kClearLine, line));  // the next output overwrites this line
}

}  // namespace handcast::supervisor
