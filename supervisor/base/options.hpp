// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The arguments of a verb, sorted. One table says what a verb takes.
struct Options {
  std::vector<std::string> words;  ///< what is not an option
  std::map<std::string, std::vector<std::string>, std::less<>>
      values;  ///< by option, "--set"; flags have one empty value

  bool has(std::string_view option) const { return values.contains(option); }
  /// The last value given, or "".
  std::string value(std::string_view option) const {
    const auto found = values.find(option);
    return found == values.end() ? std::string() : found->second.back();
  }
  std::vector<std::string> all(std::string_view option) const {
    const auto found = values.find(option);
    return found == values.end() ? std::vector<std::string>() : found->second;
  }
};

struct OptionTable {
  std::vector<std::string_view> with_value;
  std::vector<std::string_view> flags;
  std::size_t least_words = 0, most_words = 0;
};

/// Errors: bad_data, with a sentence naming the argument.
Result<Options> sort_options(const std::vector<std::string>& arguments, const OptionTable& table);

/// --seconds as a person writes it: above 0, and no more than nanoseconds can hold (30 years).
/// Errors: bad_data.
Result<double> parse_seconds(const std::string& text);

}  // namespace handcast::supervisor
