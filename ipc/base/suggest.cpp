// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <tuple>

#include "ipc/base/quote.hpp"
#include "ipc/base/text.hpp"

namespace handcast {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

constexpr std::size_t kLongest = 40;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<double> plain_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// The digits and marks at the start of the text, with an exponent: "1.234,5" of "1.234,5 ms".
std::string_view head_of(std::string_view text) {
  std::size_t end = 0;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) ++end;
  while (end < text.size() &&
         (is_digit(text[end]) || text[end] == '.' || text[end] == ',' || text[end] == '\'' ||
          (text[end] == ' ' && end + 1 < text.size() && is_digit(text[end + 1]))))
    ++end;
  if (end + 1 < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    auto after = end + 1;
    if (text[after] == '-' || text[after] == '+') ++after;
    const auto digits = after;
    while (after < text.size() && is_digit(text[after])) ++after;
    if (after > digits) end = after;
  }
  return text.substr(0, end);
}

/// The same with a decimal point, and without marks between thousands. "" if it is not one number
/// ("1,2,3.4", "192.168.0.5").
std::string without_marks(std::string_view head) {
  const auto commas = std::ranges::count(head, ','), points = std::ranges::count(head, '.');
  if (commas > 1 && points > 1) return {};
  // Of both marks, the last one is the decimal one. Of one that is there several times, none is.
  char decimal = 0;
  if (commas == 1 && (points == 0 || head.rfind(',') > head.rfind('.'))) decimal = ',';
  if (points == 1 && (commas == 0 || head.rfind('.') > head.rfind(','))) decimal = '.';
  if (decimal == 0 && commas + points > 0) return {};
  std::string plain;
  for (const char c : head)
    if (c == decimal)
      plain += '.';
    else if (c != ',' && c != '.' && c != '\'' && c != ' ')
      plain += c;
  return plain;
}

/// As TOML has it: 060 is 60, .5 is 0.5, 5. is 5.
std::string shortest(double number) { return fmt::format("{}", number); }

}  // namespace

std::string suggest(std::string_view wrong, const std::vector<std::string_view>& known) {
  constexpr std::size_t kLongestName = 100;  // the distance takes the product of the lengths
  if (wrong.size() > kLongestName) return {};
  std::string_view best;
  std::size_t best_distance = std::max<std::size_t>(2, wrong.size() / 3) + 1;
  for (const auto name : known) {
    const auto distance = edit_distance(wrong, name);
    if (distance < best_distance && distance < name.size())
      std::tie(best, best_distance) = std::tuple(name, distance);
  }
  return best.empty() ? "" : fmt::format(" (did you mean '{}'?)", best);
}

std::string meant_number(std::string_view text) {
  text = trimmed(text);
  if (text.size() > kLongest || text.empty()) return {};
  const auto head = head_of(text);
  if (std::ranges::none_of(head, is_digit)) return {};
  const auto tail = trimmed(text.substr(head.size()));
  const auto number = plain_number(without_marks(head));
  if (!number) return {};
  if (tail == "%")
    return fmt::format("write {}: a share is a number, without %", shortest(*number / 100));
  // 640x480, 192.168.0.5, 2026-11-27 and 10-bit are no number with a unit.
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           static_cast<unsigned char>(c) >= 0x80 || c == '/';
  };
  if (!std::ranges::all_of(tail, is_letter)) return {};
  if (!tail.empty()) {
    const bool has_comma = head.find(',') != head.npos;
    return fmt::format("write the number alone, {}without {}: its unit is that of the setting",
                       has_comma ? "with a decimal point and " : "", quote(tail));
  }
  if (head.find(',') != head.npos)
    return fmt::format("write {}, with a decimal point", shortest(*number));
  const bool is_plain = plain_number(head).has_value() && is_digit(head.back()) &&
                        is_digit(head[head[0] == '-' || head[0] == '+' ? 1 : 0]);
  const auto digits = head.substr(head[0] == '-' || head[0] == '+' ? 1 : 0);
  const bool has_zeros = digits.size() > 1 && digits[0] == '0' && is_digit(digits[1]);
  return is_plain && !has_zeros ? "" : fmt::format("write {}", shortest(*number));
}

}  // namespace handcast
