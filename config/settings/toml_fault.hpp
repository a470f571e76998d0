// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::config {

/// A place in a text, from 1. A column counts characters.
struct TextPlace {
  int line = 1, column = 1;
};

/// Why a text cannot be TOML at all, before it is parsed: it is in another encoding (UTF-16,
/// Latin-1) or of another kind (a picture, JSON, a web page). "FILE:LINE:COLUMN: …" with the
/// remedy; "" if it may be TOML.
std::string other_kind_of_file(std::string_view text, std::string_view file);

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
