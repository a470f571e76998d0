// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace handcast {

/// E.g. " (did you mean 'rate_hz'?)"; empty if no known name is similar.
std::string suggest(std::string_view wrong, const std::vector<std::string_view>& known);

}  // namespace handcast
