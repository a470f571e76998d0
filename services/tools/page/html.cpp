// SPDX-License-Identifier: Apache-2.0
#include "services/tools/page/html.hpp"

#include <fmt/format.h>

#include <cmath>

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

std::string base64(std::span<const unsigned char> bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(bytes.size() - i, 3);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < here ? bytes[i + k] : 0u);
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += digit <= here ? kDigits[bits >> (18 - 6 * digit) & 63] : '=';
  }
  return text;
}

std::string figure(std::optional<double> value, int digits) {
  if (!value || !std::isfinite(*value)) return "–";
  return fmt::format("{:.{}f}", *value, digits);
}

std::string missing(std::string_view sentence) {
  return fmt::format("<p class=\"missing\">{}</p>\n", escape(sentence));
}

}  // namespace handcast::page
