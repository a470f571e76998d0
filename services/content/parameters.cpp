// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "services/content/source.hpp"

namespace handcast::content {
namespace {

using Kind = Parameter::Kind;

std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "0.2,0.7"; empty if a part is no number.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  for (;;) {
    const auto comma = text.find(',');
    const auto number = number_in(text.substr(0, comma));
    if (!number) return {};
    numbers.push_back(*number);
    if (comma == text.npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

/// "#rgb", "#rrggbb" or "#rrggbbaa" as four numbers; empty if it is none.
std::vector<double> colour_in(std::string_view text) {
  const std::string_view digits = text.substr(1);
  const std::size_t width = digits.size() == 3 ? 1 : 2;
  if (digits.size() != 3 && digits.size() != 6 && digits.size() != 8) return {};
  std::vector<double> colour;
  for (std::size_t i = 0; i < digits.size(); i += width) {
    int level = 0;
    const char* const end = digits.data() + i + width;
    if (std::from_chars(digits.data() + i, end, level, 16).ptr != end) return {};
    colour.push_back(width == 1 ? level / 15.0 : level / 255.0);
  }
  colour.resize(4, 1);
  return colour;
}

std::size_t count_of(Kind kind) {
  if (kind == Kind::point) return 2;
  return kind == Kind::colour ? 4 : 1;
}

std::vector<double> parse(const Parameter& parameter, std::string_view text) {
  const Kind kind = parameter.kind;
  if (kind == Kind::colour && text.starts_with('#')) return colour_in(text);
  if (kind == Kind::flag || kind == Kind::event) {
    if (text == "true" || text == "on" || text == "yes") return {1};
    if (text == "false" || text == "off" || text == "no") return {0};
  }
  if (kind == Kind::choice)
    if (const auto found = std::ranges::find(parameter.choices, text);
        found != parameter.choices.end())
      return {parameter.values[static_cast<std::size_t>(found - parameter.choices.begin())]};
  auto numbers = numbers_in(text);
  if (kind == Kind::colour && numbers.size() == 3) numbers.push_back(1);
  if (numbers.size() != count_of(kind)) return {};
  return numbers;
}

/// "a number from 0 to 1".
std::string wanted_by(const Parameter& parameter) {
  switch (parameter.kind) {
    case Kind::flag:
    case Kind::event:
      return "true or false";
    case Kind::choice:
      return "one of " + join(parameter.choices, ", ");
    case Kind::point:
      return "two numbers, e.g. 0.5,0.5";
    case Kind::colour:
      return "a colour, e.g. #ff8800";
    default:
      break;
  }
  if (parameter.least.empty() || parameter.most.empty()) return "a number";
  return fmt::format("a number from {:g} to {:g}", parameter.least[0], parameter.most[0]);
}

}  // namespace

Result<std::vector<double>> numbers_of(const Parameter& parameter, std::string_view text) {
  auto numbers = parse(parameter, text);
  if (!numbers.empty()) return numbers;
  return fail(Errc::bad_config,
              fmt::format("{}: {} is not {}", parameter.name, quote(text), wanted_by(parameter)));
}

Result<void> Source::set(std::string_view name, std::string_view /*value*/) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : parameters()) names.push_back(parameter.name);
  return fail(Errc::bad_config,
              names.empty() ? fmt::format("there is nothing to set, and so no {}", quote(name))
                            : fmt::format("there is no {} to set; there are: {}", quote(name),
                                          join(names, ", ")));
}

}  // namespace handcast::content
