// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <string>

namespace handcast {

/// The number for a sentence, with that many decimal places; a value that rounds to zero has no
/// sign: "0.0", not "-0.0".
inline std::string number_text(double value, int places) {
  auto text = fmt::format("{:.{}f}", value, places);
  if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

/// The same with a sign if it is not zero: "+1.5", "0.0".
inline std::string signed_text(double value, int places) {
  auto text = number_text(value, places);
  const bool is_zero = text.find_first_not_of("0.") == std::string::npos;
  return is_zero || text[0] == '-' ? text : "+" + text;
}

}  // namespace handcast
