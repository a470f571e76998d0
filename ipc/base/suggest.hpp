// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace handcast {

/// E.g. " (did you mean 'rate_hz'?)"; empty if no known name is similar.
std::string suggest(std::string_view wrong, const std::vector<std::string_view>& known);

/// What a person probably meant by a text that is not a number for a program but begins like one:
/// "60,5", "60 Hz", "50%", "1'000", ".5", "060". A sentence with the number to write, e.g. "write
/// 60.5, with a decimal point"; "" if the text is a plain number, or no number at all.
std::string meant_number(std::string_view text);

}  // namespace handcast
