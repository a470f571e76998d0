// SPDX-License-Identifier: Apache-2.0
#include "config/settings/document.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "config/settings/file_kind.hpp"
#include "config/settings/toml_fault.hpp"

namespace handcast::config {
namespace {

Value convert(const toml::node& node, int line);

Value convert_table(const toml::table& table, int line) {
  Table members;
  for (const auto& [key, member] : table)
    members.push_back(
        {std::string(key.str()), convert(member, static_cast<int>(key.source().begin.line))});
  std::stable_sort(members.begin(), members.end(),
                   [](const auto& a, const auto& b) { return a.value.line < b.value.line; });
  return {std::move(members), line};
}

Value convert_array(const toml::array& array, int line) {
  Array elements;
  for (const auto& element : array)
    elements.push_back(convert(element, static_cast<int>(element.source().begin.line)));
  return {std::move(elements), line};
}

Value convert(const toml::node& node, int line) {
  if (const auto* table = node.as_table()) return convert_table(*table, line);
  if (const auto* array = node.as_array()) return convert_array(*array, line);
  if (const auto* flag = node.as_boolean()) return {flag->get(), line};
  if (const auto* whole = node.as_integer()) return {whole->get(), line};
  if (const auto* number = node.as_floating_point()) return {number->get(), line};
  if (const auto* text = node.as_string()) return {text->get(), line};
  return {OtherValue{}, line};
}

bool are_three(std::string_view toml, std::size_t at, char quote) {
  const auto three = toml.substr(at, 3);
  return three.size() == 3 && three.find_first_not_of(quote) == std::string_view::npos;
}

/// The end of the string that begins at `begin`, which has one quote on each side, or three. One
/// that is not closed ends with its line, or with the text if it has three quotes.
std::size_t end_of_string(std::string_view toml, std::size_t begin) {
  const char quote = toml[begin];
  const bool is_long = are_three(toml, begin, quote);
  for (std::size_t i = begin + (is_long ? 3 : 1); i < toml.size(); ++i) {
    if (toml[i] == '\\' && quote == '"') {
      ++i;
    } else if (!is_long && (toml[i] == quote || toml[i] == '\n')) {
      return toml[i] == quote ? i + 1 : i;
    } else if (is_long && are_three(toml, i, quote)) {
      // The last two quotes of the string itself may stand before the three that close it.
      return std::min(toml.find_first_not_of(quote, i), std::min(i + 5, toml.size()));
    }
  }
  return toml.size();
}

/// The line of the first key with more than `most` dots, which toml++ and convert() would follow by
/// recursion; 0 if there is none. Dots inside strings do not count; other recursion is limited by
/// toml++ itself.
int line_of_deep_key(std::string_view toml, int most) {
  constexpr std::string_view kBeforeKeys = "\n=,[{";
  int dots = 0;
  for (std::size_t i = 0; i < toml.size();) {
    const char c = toml[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(toml, i);
    } else if (c == '#') {
      i = std::min(toml.find('\n', i), toml.size());
    } else {
      if (kBeforeKeys.find(c) != std::string_view::npos) dots = 0;
      if (c == '.' && ++dots > most)
        return 1 + static_cast<int>(std::ranges::count(toml.substr(0, i), '\n'));
      ++i;
    }
  }
  return 0;
}

}  // namespace

Result<Value> parse_document(std::string_view toml, std::string_view file) {
  if (auto other = other_kind_of_file(toml, file); !other.empty())
    return fail(Errc::bad_config, std::move(other));
  constexpr int kMostDots = 32;
  if (const int line = line_of_deep_key(toml, kMostDots); line > 0)
    return fail(Errc::bad_config,
                fmt::format("{}:{}: a key has more than {} parts", file, line, kMostDots));
  try {
    return convert_table(toml::parse(toml, file), 1);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    return fail(Errc::bad_config,
                toml_fault(toml, file, {static_cast<int>(at.line), static_cast<int>(at.column)},
                           error.description()));
  }
}

std::string_view kind_of(const Value& value) {
  constexpr std::string_view kKinds[] = {"a date or time", "true or false", "a whole number",
                                         "a number",       "text",          "a list",
                                         "a section"};
  return kKinds[value.data.index()];
}

}  // namespace handcast::config
