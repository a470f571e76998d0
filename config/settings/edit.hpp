// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// The text of a TOML document with another value of a setting. Every other byte stays: comments,
/// blanks, ends of lines, the order. A setting that is not there gets a place where the document
/// allows it: in its section, in its inline table, beside dotted keys of its section, or in a new
/// section at the end. The result is read again and says what the document said, except for that
/// value. `path`: "projector.latency_ms". `value`: as TOML ("10.2", "\"a\""). `file` is used in
/// messages. Errors: bad_config (the text is not TOML, or cannot be edited so; the sentence says
/// which line to write by hand).
Result<std::string> with_value(const std::string& toml, const std::string& path,
                               const std::string& value, std::string_view file);

}  // namespace handcast::config
