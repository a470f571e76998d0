// SPDX-License-Identifier: Apache-2.0
#include "services/tools/page/html.hpp"

namespace handcast::page {

std::string escape(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string fill(std::string_view skeleton,
                 const std::map<std::string, std::string, std::less<>>& values) {
  std::string filled;
  for (;;) {
    const auto open = skeleton.find("{{");
    const auto close = skeleton.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos)
      return filled.append(skeleton);
    filled.append(skeleton.substr(0, open));
    if (const auto value = values.find(skeleton.substr(open + 2, close - open - 2));
        value != values.end())
      filled += value->second;
    skeleton.remove_prefix(close + 2);
  }
}

}  // namespace handcast::page
