// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The arguments of a verb, sorted according to an OptionTable.
struct Options {
  std::vector<std::string> words;  ///< the arguments that are not options
  /// The values of each option ("--set") in their order. A flag has an empty value.
  std::map<std::string, std::vector<std::string>, std::less<>> values;

  /// True if the option was given.
  bool has(std::string_view option) const { return values.contains(option); }
  /// The last value of an option; "" if it was not given.
  std::string value(std::string_view option) const {
    const auto found = values.find(option);
    return found == values.end() ? std::string() : found->second.back();
  }
  /// All values of an option; empty if it was not given.
  std::vector<std::string> all(std::string_view option) const {
    const auto found = values.find(option);
    return found == values.end() ? std::vector<std::string>() : found->second;
  }
};

/// The arguments that a verb accepts.
struct OptionTable {
  std::vector<std::string_view> with_value;  ///< options that are followed by a value
  std::vector<std::string_view> flags;       ///< options without a value
  std::vector<std::string_view> words{};     ///< names of the arguments that must be given
  std::size_t more_words = 0;                ///< how many other arguments may follow them
};

/// Sorts the arguments of a verb. Errors: bad_data, with a sentence that names the argument.
Result<Options> sort_options(const std::vector<std::string>& arguments, const OptionTable& table);

/// Parses the value of --seconds: above 0 and at most 30 years, which fit into an int64 of
/// nanoseconds. Errors: bad_data.
Result<double> parse_seconds(const std::string& text);

}  // namespace handcast::supervisor
