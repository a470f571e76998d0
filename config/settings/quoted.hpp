// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::config {

/// A text as TOML writes it: in quotes, with escapes.
std::string quoted(std::string_view text);

}  // namespace handcast::config
