// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "ipc/base/log.hpp"

namespace handcast {

/// The text without the spaces, tabs and line ends at its beginning and end.
inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  return text.substr(0, text.find_last_not_of(kBlanks) + 1);
}

/// A text as it stands in HTML, between tags or in an attribute: printable(), without markup.
inline std::string html_of(std::string_view text) {
  std::string html;
  for (const char c : printable(text))
    html += std::string_view("<>&\"").find(c) == text.npos ? std::string(1, c)
                                                           : fmt::format("&#{};", int{c});
  return html;
}

}  // namespace handcast
