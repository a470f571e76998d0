// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/environment.hpp"

#include <charconv>
#include <cstdlib>

namespace handcast::service {
namespace {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

RingFds parse_rings(std::string_view text) {
  RingFds rings;
  while (!text.empty()) {
    const auto comma = text.find(',');
    const auto entry = text.substr(0, comma);
    text = comma == std::string_view::npos ? std::string_view{} : text.substr(comma + 1);
    const auto equals = entry.find('=');
    if (equals == 0 || equals == std::string_view::npos) continue;
    if (const auto fd = parse_number<int>(entry.substr(equals + 1)); fd && *fd >= 0)
      rings.emplace(entry.substr(0, equals), *fd);
  }
  return rings;
}

std::optional<std::int64_t> number_from_environment(const char* name) {
  const char* text = std::getenv(name);
  return text ? parse_number<std::int64_t>(text) : std::nullopt;
}

}  // namespace handcast::service
