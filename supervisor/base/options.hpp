// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The arguments of a verb, sorted by what an OptionTable says.
struct Options {
  std::vector<std::string> words;  ///< what is not an option
  /// The values of each option ("--set") in their order. A flag has an empty value.
  std::map<std::string, std::vector<std::string>, std::less<>> values;

  /// Whether the option was given.
  bool has(std::string_view option) const { return values.contains(option); }
  /// The last value of an option; "" if it was not given.
  std::string value(std::string_view option) const {
    const auto found = values.find(option);
    return found == values.end() ? std::string() : found->second.back();
  }
  /// All values of an option.
  std::vector<std::string> all(std::string_view option) const {
    const auto found = values.find(option);
    return found == values.end() ? std::vector<std::string>() : found->second;
  }
};

/// What a verb takes.
struct OptionTable {
  std::vector<std::string_view> with_value;
  std::vector<std::string_view> flags;
  std::size_t least_words = 0, most_words = 0;
};

/// Sorts the arguments of a verb. Errors: bad_data, with a sentence that names the argument.
Result<Options> sort_options(const std::vector<std::string>& arguments, const OptionTable& table);

/// The value of --seconds: above 0, and no more than an int64 of nanoseconds can hold (30 years).
/// Errors: bad_data.
Result<double> parse_seconds(const std::string& text);

}  // namespace handcast::supervisor
