// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace handcast::config {

/// Where the parts of a TOML document stand in its text, which parse_document() does not tell.
struct Layout {
  /// The parts of a key: {"projector", "latency_ms"}.
  using Path = std::vector<std::string>;
  /// Bytes of the text: [begin, end).
  struct Span {
    std::size_t begin = 0, end = 0;
  };

  /// What can hold keys: the top level of the file, a section below its header, an inline table.
  struct Container {
    enum class Kind { file, section, inline_table };
    Kind kind = Kind::file;
    Path path;
    Span at{};             ///< the header, or the inline table with its braces; empty for the file
    bool in_list = false;  ///< one of several tables of the same name, which a path does not name
  };
  /// A key with its value. Keys inside lists are left out.
  struct Entry {
    std::size_t container = 0;  ///< index in `containers`
    Path path;                  ///< of the whole document
    Span key{}, value{};
    int line = 0;  ///< of the key, from 1
  };

  std::vector<Container> containers;  ///< in the order of the text; the first is the file
  std::vector<Entry> entries;         ///< in the order of the text
};

/// The layout of a text that is valid TOML 1.0; that of any other text is of no use, but does not
/// reach beyond it.
Layout layout_of(std::string_view toml);

}  // namespace handcast::config
