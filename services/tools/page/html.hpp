// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>

namespace handcast::page {

/// Escapes text for HTML, including the values of attributes.
std::string escape(std::string_view text);

/// Replaces each {{name}} of a skeleton by its value, or by "" without one. Values are inserted as
/// they are: a {{name}} in a value is not replaced.
std::string fill(std::string_view skeleton,
                 const std::map<std::string, std::string, std::less<>>& values);

}  // namespace handcast::page
