// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "ipc/base/suggest.hpp"

namespace handcast::supervisor {
namespace {

std::string similar(const std::string& option, const OptionTable& table) {
  auto known = table.flags;
  known.insert(known.end(), table.with_value.begin(), table.with_value.end());
  return suggest(option, known);
}

}  // namespace

Result<Options> sort_options(const std::vector<std::string>& arguments, const OptionTable& table) {
  const auto is_in = [](const auto& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto& argument = arguments[i];
    if (argument.empty()) return fail(Errc::bad_data, "an argument is empty");
    if (!argument.starts_with("--"))
      options.words.push_back(argument);
    else if (is_in(table.flags, argument))
      options.values[argument].emplace_back();
    else if (!is_in(table.with_value, argument))
      return fail(Errc::bad_data,
                  fmt::format("unknown option '{}'{}", argument, similar(argument, table)));
    else if (i + 1 == arguments.size() || arguments[i + 1].empty())
      return fail(Errc::bad_data, fmt::format("{} needs a value", argument));
    else
      options.values[argument].push_back(arguments[++i]);
  }
  if (options.words.size() < table.words.size())
    return fail(Errc::bad_data, fmt::format("{} is missing", table.words[options.words.size()]));
  if (options.words.size() > table.words.size() + table.more_words)
    return fail(Errc::bad_data, fmt::format("'{}' is one argument too many", options.words.back()));
  return options;
}

Result<double> parse_seconds(const std::string& text) {
  constexpr double kMost_s = 1e9;
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  const bool whole = error == std::errc{} && end == text.data() + text.size();
  if (whole && seconds > 0 && seconds <= kMost_s) return seconds;
  return fail(Errc::bad_data,
              fmt::format("--seconds {}: must be a number above 0, up to {:g}", text, kMost_s));
}

}  // namespace handcast::supervisor
