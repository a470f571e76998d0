// SPDX-License-Identifier: Apache-2.0
// The output of `handcast up` on stderr. On a terminal, the last line is a progress line that is
// replaced; other lines are printed above it.
#pragma once
#include <string_view>

namespace handcast::supervisor {

/// Prints a line to stderr. On a terminal, it first erases the progress line. In the journal, the
/// line has the priority of its level (log::for_journal()).
void print_line(std::string_view line);
/// Replaces the progress line of the terminal.
void show_progress(std::string_view line);
/// True if stderr is a terminal.
bool has_terminal();

}  // namespace handcast::supervisor
