// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace handcast::supervisor {

/// Lines for the person in front of `handcast up`, on stderr. On a terminal one progress line stays
/// below the others.
void print_line(std::string_view line);
/// On a terminal: replaces the progress line. Elsewhere: prints a line.
void show_progress(std::string_view line);
bool has_terminal();

}  // namespace handcast::supervisor
