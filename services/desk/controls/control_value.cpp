// SPDX-License-Identifier: Apache-2.0
#include "services/desk/controls/control_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "config/settings/quoted.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"

namespace handcast::desk {
namespace {

Result<void> check_range(const Control& control, double number, const std::string& text) {
  if (number >= control.range.min && number <= control.range.max && std::isfinite(number))
    return {};
  const auto allowed = print_allowed(control);
  return fail(Errc::bad_data, allowed.empty() ? fmt::format("{} is no finite number", text)
                                              : fmt::format("{} is outside {}", text, allowed));
}

std::string assign(const Control& control, std::string_view value) {
  return fmt::format("{}={}", control.path, value);
}

}  // namespace

config::Value read_value(std::string_view toml) {
  auto document = config::parse_document(fmt::format("value = {}", toml), "");
  auto* members = document ? std::get_if<config::Table>(&document->data) : nullptr;
  if (!members || members->empty()) return {std::string(), 1};
  return std::move(members->front().value);
}

std::optional<double> number_of(const Control& control, std::string_view toml) {
  const auto value = read_value(toml);
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? 1 : 0;
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  const auto* word = std::get_if<std::string>(&value.data);
  const auto found = word ? std::ranges::find(control.words, *word) : control.words.end();
  if (found == control.words.end()) return std::nullopt;
  return static_cast<double>(found - control.words.begin());
}

std::string print_allowed(const Control& control) {
  if (control.kind == Kind::choice) return "one of: " + join(control.words, ", ");
  const auto& range = control.range;
  const std::string unit = range.unit.empty() ? "" : fmt::format(" {}", range.unit);
  if (std::isfinite(range.min) && std::isfinite(range.max))
    return fmt::format("{}..{}{}", range.min, range.max, unit);
  if (std::isfinite(range.min)) return fmt::format("at least {}{}", range.min, unit);
  return "";
}

std::string print_number(double number, bool is_float) {
  return is_float ? fmt::format("{}", static_cast<float>(number)) : fmt::format("{}", number);
}

Result<std::string> assign_number(const Control& control, double number, bool is_float) {
  const auto text = print_number(number, is_float);
  if (is_float) number = std::strtod(text.c_str(), nullptr);
  const bool is_whole = std::isfinite(number) && number == std::floor(number);
  switch (control.kind) {
    case Kind::toggle:
      if (std::isnan(number)) return fail(Errc::bad_data, text + " is neither on nor off");
      return assign(control, number >= 0.5 ? "true" : "false");
    case Kind::whole:
      if (!is_whole) return fail(Errc::bad_data, text + " is no whole number");
      [[fallthrough]];
    case Kind::number:
    case Kind::numbers:
      return check_range(control, number, text).map([&] {
        return assign(control, is_whole && std::abs(number) < 1e15
                                   ? fmt::format("{:.0f}", number + 0.0)  // no "-0", no "1e+06"
                                   : text);
      });
    case Kind::choice:
      if (!is_whole || number < 0 || number >= static_cast<double>(control.words.size()))
        return fail(Errc::bad_data,
                    fmt::format("{} is no place in the list 0..{} ({})", text,
                                control.words.size() - 1, join(control.words, ", ")));
      return assign(control, config::quoted(control.words[static_cast<std::size_t>(number)]));
    case Kind::text:
    case Kind::texts:
      break;
  }
  return fail(Errc::bad_data, fmt::format("{} is a number, but a text is expected", text));
}

Result<std::string> assign_text(const Control& control, std::string_view text) {
  switch (control.kind) {
    case Kind::text:
      return assign(control, config::quoted(text));
    case Kind::texts:
      return assign(control, fmt::format("[{}]", config::quoted(text)));
    case Kind::choice: {
      if (std::ranges::find(control.words, text) != control.words.end())
        return assign(control, config::quoted(text));
      const std::vector<std::string_view> words(control.words.begin(), control.words.end());
      return fail(Errc::bad_data, fmt::format("{} is not {}{}", quote(text), print_allowed(control),
                                              suggest(text, words)));
    }
    default:
      break;
  }
  return fail(Errc::bad_data,
              fmt::format("{} is a text, but {} is expected", quote(text),
                          control.kind == Kind::toggle ? "on or off (T, F, 1, 0)" : "a number"));
}

}  // namespace handcast::desk
