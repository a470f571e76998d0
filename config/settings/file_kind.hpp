// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::config {

/// Why a text cannot be TOML at all, before it is parsed: it is in another encoding (UTF-16,
/// Latin-1) or of another kind (a picture, JSON, a web page). "FILE:LINE:COLUMN: …" with the
/// remedy; "" if it may be TOML.
std::string other_kind_of_file(std::string_view text, std::string_view file);

}  // namespace handcast::config
