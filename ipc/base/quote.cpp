// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/quote.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast {
namespace {

unsigned char byte_of(char c) { return static_cast<unsigned char>(c); }
bool is_continuation(char c) { return (byte_of(c) & 0xc0) == 0x80; }

/// U+0080 to U+009F, which some terminals obey as they do ESC sequences.
bool is_c1_control(std::string_view character) {
  return character.size() == 2 && byte_of(character[0]) == 0xc2 && byte_of(character[1]) < 0xa0;
}

bool is_control(std::string_view character) {
  return byte_of(character[0]) < 0x20 || character[0] == 0x7f || is_c1_control(character);
}

std::string in_hex(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("\\x{:02x}", byte_of(c));
  return text;
}

std::string escaped(std::string_view bytes) {
  if (bytes == "\n") return "\\n";
  if (bytes == "\r") return "\\r";
  if (bytes == "\t") return "\\t";
  return in_hex(bytes);
}

/// The beginning and the end of a text, between characters.
struct Ends {
  std::string_view begin, end;
};

Ends ends_of(std::string_view text, std::size_t most) {
  auto begin = most - most / 4, end = text.size() - most / 4;
  while (begin > 0 && is_continuation(text[begin])) --begin;
  while (end < text.size() && is_continuation(text[end])) ++end;
  return {text.substr(0, begin), text.substr(end)};
}

std::string in_one_line(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const auto count = bytes_of_character(text);
    const auto character = text.substr(0, std::max<std::size_t>(count, 1));
    shown += count == 0 || is_control(character) ? escaped(character) : std::string(character);
    text.remove_prefix(character.size());
  }
  return shown;
}

}  // namespace

std::size_t bytes_of_character(std::string_view text) {
  const auto first = byte_of(text.front());
  const std::size_t count = first < 0x80                     ? 1
                            : first >= 0xc2 && first <= 0xdf ? 2
                            : (first & 0xf0) == 0xe0         ? 3
                            : first >= 0xf0 && first <= 0xf4 ? 4
                                                             : 0;
  const auto character = text.substr(0, count);
  const bool is_whole = character.size() == count && count > 0 &&
                        std::all_of(character.begin() + 1, character.end(), is_continuation);
  return is_whole ? count : 0;
}

std::string quote(std::string_view text, std::size_t most) {
  if (text.size() <= most) return fmt::format("'{}'", in_one_line(text));
  const auto [begin, end] = ends_of(text, most);
  return fmt::format("'{}…{}' ({} bytes)", in_one_line(begin), in_one_line(end), text.size());
}

std::string shown_line(std::string_view line, std::size_t most) {
  if (line.size() > most) {
    const auto [begin, end] = ends_of(line, most);
    return fmt::format("{}… ({} bytes) …{}", shown_line(begin, most), line.size(),
                       shown_line(end, most));
  }
  std::string shown;
  while (!line.empty()) {
    const auto character = line.substr(0, std::max<std::size_t>(bytes_of_character(line), 1));
    shown +=
        character != "\t" && is_control(character) ? in_hex(character) : std::string(character);
    line.remove_prefix(character.size());
  }
  return shown;
}

}  // namespace handcast
