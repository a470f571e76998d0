// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::config {

/// A sentence about the first line of printed settings that is not UTF-8; "" if they can be read.
std::string why_unreadable(std::string_view toml);

/// Why a text cannot be TOML at all, before it is parsed: it is in another encoding (UTF-16,
/// Latin-1) or of another kind (a picture, JSON, a web page). "FILE:LINE:COLUMN: …" with the
/// remedy; "" if it may be TOML.
std::string other_kind_of_file(std::string_view text, std::string_view file);

}  // namespace handcast::config
