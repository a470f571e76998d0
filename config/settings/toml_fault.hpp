// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace handcast::config {

/// A place in a text, from 1. A column counts characters.
struct TextPlace {
  int line = 1, column = 1;
};

/// The column of a byte of a line.
int column_of(std::string_view line, std::size_t at);

/// The message about TOML that a parser refused at a place with these words: what a person probably
/// meant ("text needs quotes: backend = \"window\""), or else the parser's words, then the line and
/// a caret below the fault:
///
///     rig.toml:3:11: text needs quotes: backend = "window"
///         backend = window
///                   ^
std::string toml_fault(std::string_view toml, std::string_view file, TextPlace refused,
                       std::string_view parsers_words);

}  // namespace handcast::config
