// SPDX-License-Identifier: Apache-2.0
#include "config/settings/document.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

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

/// The line of the first key with more than `most` dots, which toml++ and convert() would follow by
/// recursion; 0 if there is none. Dots inside quotes do not count; other recursion is limited by
/// toml++ itself.
int line_of_deep_key(std::string_view toml, int most) {
  int line = 1, dots = 0;
  char quote = 0;  // or '#', in a comment
  for (std::size_t i = 0; i < toml.size(); ++i) {
    const char c = toml[i];
    if (c == '\n') ++line, dots = 0, quote = 0;
    if (quote) {
      if (c == quote && quote != '#') quote = 0;
      if (c == '\\' && quote == '"') ++i;
    } else if (c == '"' || c == '\'' || c == '#') {
      quote = c;
    } else if (c == '=' || c == ',' || c == '[' || c == '{') {
      dots = 0;
    } else if (c == '.' && ++dots > most) {
      return line;
    }
  }
  return 0;
}

}  // namespace

Result<Value> parse_document(std::string_view toml, std::string_view file) {
  constexpr int kMostDots = 32;
  if (const int line = line_of_deep_key(toml, kMostDots); line > 0)
    return fail(Errc::bad_config,
                fmt::format("{}:{}: a key has more than {} parts", file, line, kMostDots));
  try {
    return convert_table(toml::parse(toml, file), 1);
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    return fail(Errc::bad_config, fmt::format("{}:{}:{}: not TOML: {}", file, at.line, at.column,
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
