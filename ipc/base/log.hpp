// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace handcast {

/// The text with control characters other than line ends and tabs as \xNN. Names from files and
/// command lines may hold sequences that move the cursor of a terminal.
std::string printable(std::string_view text);

}  // namespace handcast

namespace handcast::log {

/// The severity of a log line, lowest first.
enum class Level { debug, info, warning, error };

/// Sets the name of this process that each line carries, e.g. "camera". Call it once at start-up,
/// before other threads log.
void set_program(std::string_view name);
/// Sets the lowest level that is written. The default is info, or the value of the environment
/// variable HANDCAST_LOG (debug, info, warning or error). Any thread.
void set_level(Level level);

/// The parts of a line that write() has made.
struct ParsedLine {
  Level level;                ///< its third word
  std::string_view sentence;  ///< what follows the level; a part of the line
};
/// The parts of a line. Empty if write() cannot have made it.
std::optional<ParsedLine> parse(std::string_view line);

/// `text` with the syslog priority of `level` before each of its
/// lines ("<4>" for a warning) if stderr is the journal of systemd ($JOURNAL_STREAM). Otherwise
/// unchanged.
std::string for_journal(Level level, std::string text);

/// Writes text to stderr. A terminal that was closed is no error. Any thread.
void put(std::string_view text);
/// From now on, put() waits at most `patience` for a terminal, a pipe or the journal, and not at
/// all until it takes text again: a supervisor must not stand still because a reader does (Ctrl-S,
/// a hung ssh). Later a line says how many lines are missing. Files are written as before. Call it
/// once, before other threads log (see ImpatientWriter).
void never_wait_for_stderr(std::chrono::milliseconds patience = std::chrono::milliseconds(50));

/// Writes one line to stderr: "12.345 camera  info  …", the time in seconds of CLOCK_MONOTONIC. In
/// the journal, with for_journal(). Any thread.
void write(Level level, std::string_view line);

/// Formats a line with fmt and writes it at the level of the function's name. Any thread.
/// @{
template <class... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::debug, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::info, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void warning(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::warning, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void error(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::error, fmt::format(format, std::forward<Args>(args)...));
}
/// @}

}  // namespace handcast::log
