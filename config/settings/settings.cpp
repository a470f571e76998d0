// SPDX-License-Identifier: Apache-2.0
#include "config/settings/settings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "config/settings/quoted.hpp"
#include "ipc/base/join.hpp"

namespace handcast::config {
namespace {

std::string print(bool flag) { return flag ? "true" : "false"; }
std::string print(int whole) { return fmt::format("{}", whole); }
/// The shortest text that reads back as the same number.
std::string print(double number) { return fmt::format("{}", number); }

std::string print(const std::string& text) { return config::quoted(text); }

template <class T>
std::string print(const std::vector<T>& elements) {
  std::vector<std::string> texts;
  texts.reserve(elements.size());
  for (const T& element : elements) texts.push_back(print(element));
  return fmt::format("[{}]", join(texts, ", "));
}

std::string print_target(const ChoiceTarget& choice) { return print(std::string(choice.word())); }

template <class Value>
std::string print_target(const Value* value) {
  return print(*value);
}

std::string comment_for(const Setting& setting) {
  const auto allowed = print_allowed(setting);
  return fmt::format("# {}{}\n", setting.sentence,
                     allowed.empty() ? "" : fmt::format(" ({})", allowed));
}

}  // namespace

const Setting* find_setting(const Listing& listing, std::string_view path) {
  for (const auto& section : listing)
    for (const auto& setting : section.settings)
      if (setting.path == path) return &setting;
  return nullptr;
}

std::string print_value(const Setting& setting) {
  return std::visit([](const auto& target) { return print_target(target); }, setting.target);
}

std::string print_allowed(const Setting& setting) {
  if (const auto words = setting.words(); !words.empty())
    return fmt::format("one of: {}", join(words, ", "));
  const auto& range = setting.range;
  const bool low = std::isfinite(range.min), high = std::isfinite(range.max);
  std::string allowed;
  if (low && high) allowed = fmt::format("{}..{}", range.min, range.max);
  if (low && !high) allowed = fmt::format("at least {}", range.min);
  if (!low && high) allowed = fmt::format("at most {}", range.max);
  if (!range.unit.empty())
    allowed += fmt::format("{}{}", allowed.empty() ? "in " : " ", range.unit);
  return allowed;
}

std::string print_settings(const Listing& listing, std::string_view title) {
  std::string toml = fmt::format("# {}\n", title);
  for (const auto& section : listing) {
    if (!section.path.empty())
      toml += fmt::format("\n# {}\n[{}]\n", section.sentence, section.path);
    for (const auto& setting : section.settings)
      toml +=
          fmt::format("{}{} = {}\n", comment_for(setting), setting.name(), print_value(setting));
  }
  return toml;
}

}  // namespace handcast::config
