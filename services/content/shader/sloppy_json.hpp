// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

namespace handcast::content::shader {

/// JSON as people write it by hand, as JSON: without comments and commas at the end of a list;
/// with a digit before and behind each point; control characters and odd backslashes in texts
/// escaped, and bytes that are not UTF-8 as '?'. Lines stay where they are. What is no JSON stays
/// none.
std::string strict_json(std::string_view text);

}  // namespace handcast::content::shader
