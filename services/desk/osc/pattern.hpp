// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

namespace handcast::desk::osc {

/// True if an address has signs of a pattern: ? * [ {
bool is_pattern(std::string_view address);

/// True if `pattern` stands for `address`: ? is one character, * any number of them, [a-z] one of
/// them, [!a-z] one of the others, {left,right} one of these; none of them is a '/'. Each step of
/// the search takes one from `steps`; without any left the answer is false: `*a*a*a*…` would take
/// forever.
bool matches(std::string_view pattern, std::string_view address, int& steps);

}  // namespace handcast::desk::osc
