// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::config {

struct Value;
struct Member;
/// A list of values.
using Array = std::vector<Value>;
/// A section, in the order of the file.
using Table = std::vector<Member>;

/// A date or time. It is kept so that messages can name it; no setting accepts one.
struct OtherValue {};

/// One value of a TOML document with its line.
struct Value {
  /// The value by kind; a Table is a section.
  std::variant<OtherValue, bool, std::int64_t, double, std::string, Array, Table> data;
  int line = 0;  ///< line of its key, from 1
};

/// One key of a section with its value.
struct Member {
  std::string name;  ///< the key
  Value value;       ///< the value
};

/// Parses a TOML document into one table. The only function that uses a TOML library. `file` is
/// used in messages. Errors: bad_config ("FILE:LINE:COLUMN: …", what was
/// probably meant, and the line: see toml_fault()).
Result<Value> parse_document(std::string_view toml, std::string_view file);

/// The kind of a value for messages: "a number", "text", "a section".
std::string_view kind_of(const Value& value);

}  // namespace handcast::config
