// SPDX-License-Identifier: Apache-2.0
// What `handcast up` writes to the person who started it, on stderr. On a terminal the last line is
// a progress line that is replaced; other lines are printed above it.
#pragma once
#include <string_view>

namespace handcast::supervisor {

/// Prints a line.
void print_line(std::string_view line);
/// Replaces the progress line. Without a terminal: prints a line.
void show_progress(std::string_view line);
/// Whether stderr is a terminal.
bool has_terminal();

}  // namespace handcast::supervisor
