// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace handcast::config {

/// An enum that can be the type of a setting. words_of() gives its words in the order of the
/// enumerators, which must count up from 0:
///
///     enum class FillMethod { none, reflect };
///     constexpr std::array<std::string_view, 2> words_of(FillMethod) {
///       return {"none", "reflect"};
///     }
template <class Enum>
concept Choice = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value).size();
};

/// The word of `value` in a rig file.
template <Choice Enum>
constexpr std::string_view word_of(Enum value) {
  return words_of(value)[static_cast<std::size_t>(value)];
}

/// The value with this word; empty if there is none.
template <Choice Enum>
constexpr std::optional<Enum> choice_named(std::string_view word) {
  constexpr auto words = words_of(Enum{});
  const auto found = std::ranges::find(words, word);
  if (found == words.end()) return std::nullopt;
  return static_cast<Enum>(found - words.begin());
}

}  // namespace handcast::config
