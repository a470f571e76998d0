// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace handcast {

/// The bytes of a text from outside that a message shows.
inline constexpr std::size_t kMostQuoted = 80;

/// A text from a file, a device or a command line as a message shows it: 'text', on one line. Line
/// ends, tabs and other control characters are escaped (\n, \x1b), and so are bytes that are not
/// UTF-8. A text of more than `most` bytes keeps its ends: 'AAAA…ZZZZ' (838000 bytes).
std::string quote(std::string_view text, std::size_t most = kMostQuoted);

/// The bytes of the UTF-8 character at the start of a text that is not empty; 0 if there is none.
std::size_t bytes_of_character(std::string_view text);

/// A line with control characters other than tabs as \xNN. Bytes that are not UTF-8 stay. One of
/// more than `most` bytes keeps its ends.
std::string shown_line(std::string_view line, std::size_t most);

}  // namespace handcast
