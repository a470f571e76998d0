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
using Array = std::vector<Value>;
using Table = std::vector<Member>;  ///< in the order of the file

/// A date or time: read, so that it can be named in a message, but no setting takes one.
struct OtherValue {};

/// One value of a TOML document and where it stands.
struct Value {
  std::variant<OtherValue, bool, std::int64_t, double, std::string, Array, Table> data;
  int line = 0;  ///< of its key, from 1
};

struct Member {
  std::string name;
  Value value;
};

/// The whole document as one table. The only function that uses a TOML library.
/// Errors (bad_config): "FILE:LINE:COLUMN: …" where the text is not TOML.
Result<Value> parse_document(std::string_view toml, std::string_view file);

/// "a number", "text", "a section": for messages about a value of the wrong kind.
std::string_view kind_of(const Value& value);

}  // namespace handcast::config
