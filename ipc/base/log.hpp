// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace handcast::log {

enum class Level { debug, info, warning, error };

/// Names this process in every line ("camera"), once, at start-up.
void set_program(std::string_view name);
/// Lines below this level are not written. Default: info; HANDCAST_LOG=debug|info|warning|error
/// changes it.
void set_level(Level level);

/// One line to stderr in one write(): "12.345 camera  info  …" (seconds of CLOCK_MONOTONIC). Safe
/// from any thread.
void write(Level level, std::string_view line);

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

}  // namespace handcast::log
