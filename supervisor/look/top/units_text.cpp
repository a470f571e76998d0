// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/units_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace handcast::supervisor {
namespace {

struct Unit {
  double size;
  std::string_view name;
};

/// Formats with at least three digits: "1020", "999", "99.9", "9.99", without trailing zeros.
std::string three_digits(double value) {
  return std::abs(value) < 999.5 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

/// Formats a value in the largest unit in which it is at least 1. `units` are in ascending order.
template <std::size_t N>
std::string in_units(double value, const std::array<Unit, N>& units) {
  auto unit = units.front();
  for (const auto& next : units)
    if (std::abs(value) >= 0.9995 * next.size) unit = next;  // 999.7 would be printed as 1000
  return three_digits(value / unit.size) + " " + std::string(unit.name);
}

std::string two_units(std::int64_t span_s, std::int64_t large, std::string_view large_name,
                      std::int64_t small, std::string_view small_name) {
  const auto rest = span_s % large / small;
  const auto text = fmt::format("{} {}", span_s / large, large_name);
  return rest == 0 ? text : fmt::format("{} {} {}", text, rest, small_name);
}

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

}  // namespace

std::string text_of_span(std::int64_t span_ns) {
  constexpr std::int64_t kMinute_s = 60, kHour_s = 3600, kDay_s = 86400;
  const auto span_s = span_ns / 1'000'000'000;
  if (span_s >= kDay_s) return two_units(span_s, kDay_s, "d", kHour_s, "h");
  if (span_s >= kHour_s) return two_units(span_s, kHour_s, "h", kMinute_s, "min");
  if (span_s >= kMinute_s) return two_units(span_s, kMinute_s, "min", 1, "s");
  return in_units(static_cast<double>(span_ns),
                  std::array<Unit, 4>{{{1, "ns"}, {1e3, "us"}, {1e6, "ms"}, {1e9, "s"}}});
}

std::string text_of_bytes(std::int64_t bytes) {
  constexpr double kKibi = 1024;
  static constexpr std::array<Unit, 4> kUnits{
      {{1, "B"}, {kKibi, "KiB"}, {kKibi * kKibi, "MiB"}, {kKibi * kKibi * kKibi, "GiB"}}};
  return in_units(static_cast<double>(bytes), kUnits);
}

std::string text_of_rate(double per_second) {
  return in_units(per_second, std::array<Unit, 2>{{{1, "Hz"}, {1e3, "kHz"}}});
}

std::string text_of_share(double share) {
  return share < 0.9995 ? fmt::format("{:.1f} %", share * 100)
                        : fmt::format("{:.0f} %", share * 100);
}

std::string text_of_count(std::uint64_t count) {
  auto text = std::to_string(count);
  for (auto at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), 1, ' ');
  return text;
}

std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  for (const char byte : text)
    if (!is_continuation(byte)) ++columns;
  return columns;
}

std::string cut_to(std::string_view text, std::size_t columns) {
  if (columns_of(text) <= columns) return std::string(text);
  std::size_t bytes = 0;
  for (std::size_t kept = 0; bytes < text.size(); ++bytes)
    if (!is_continuation(text[bytes]) && ++kept > columns - (columns > 0 ? 1 : 0)) break;
  return std::string(text.substr(0, bytes)) + (columns > 0 ? "…" : "");
}

std::string harmless(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool second_control = byte == 0xc2 && i + 1 < text.size() &&
                                static_cast<unsigned char>(text[i + 1]) < 0xa0;  // U+0080 to U+009F
    if (second_control) ++i;
    result += byte < 0x20 || byte == 0x7f || second_control ? '?' : text[i];
  }
  return result;
}

}  // namespace handcast::supervisor
