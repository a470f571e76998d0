// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/join.hpp"

namespace handcast {

/// "0.1 to 2592000" of CLI11's "0.1 - 2.592e+06" or "0.100000 to 2592000.000000".
inline std::string spoken_range(const std::string& range, std::string_view between) {
  const auto middle = range.find(between);
  if (middle == std::string::npos) return range;
  return fmt::format("{} to {}", std::strtod(range.c_str(), nullptr),
                     std::strtod(range.c_str() + middle + between.size(), nullptr));
}

/// The text of --help: CLI11's, with kinds and ranges of values as a person says them: "--after N",
/// "(0.1 to 3600; default: 2)".
class VerbHelp : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    const auto kind = option->get_type_name();
    if (kind.empty() || option->get_positional()) return "";  // a flag has no kind
    const auto begin = kind.find('{'), end = kind.rfind('}');
    if (begin != std::string::npos && end != std::string::npos)
      return " " + words_of(kind.substr(begin + 1, end - begin - 1));
    const bool is_number = kind.starts_with("FLOAT") || kind.starts_with("INT");
    return is_number ? " N" : " VALUE";
  }

  std::string make_option_desc(const CLI::Option* option) const override {
    std::vector<std::string> parts;
    if (option->get_required() && !option->get_positional()) parts.emplace_back("required");
    if (auto range = range_of(*option); !range.empty()) parts.push_back(std::move(range));
    const auto usual = option->get_default_str();
    const bool said = option->get_description().find("default:") != std::string::npos;
    if (!usual.empty() && !said) parts.push_back("default: " + usual);
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size &&
        !option->get_positional())
      parts.emplace_back("may be repeated");
    return option->get_description() +
           (parts.empty() ? "" : fmt::format(" ({})", join(parts, "; ")));
  }

 private:
  /// "left|right" of "left, right".
  static std::string words_of(std::string choices) {
    std::erase(choices, ' ');
    std::ranges::replace(choices, ',', '|');
    return choices;
  }

  /// "0.1 to 3600" of "FLOAT:FLOAT in [0.1 - 3600]"; "" without a range.
  static std::string range_of(const CLI::Option& option) {
    const auto kind = option.get_type_name();
    const auto begin = kind.find(" in [");
    if (begin == std::string::npos || !kind.ends_with(']')) return "";
    constexpr std::size_t kBefore = 5;
    return spoken_range(kind.substr(begin + kBefore, kind.size() - 1 - begin - kBefore), " - ");
  }
};

}  // namespace handcast
