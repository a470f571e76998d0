// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/pattern.hpp"

namespace handcast::desk::osc {
namespace {

/// Whether a character is of the set "a-z", "!a-z".
bool is_in_set(std::string_view set, char character) {
  const bool is_negated = set.starts_with('!');
  if (is_negated) set.remove_prefix(1);
  bool is_in = false;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (i + 2 < set.size() && set[i + 1] == '-') {
      is_in |= set[i] <= character && character <= set[i + 2];
      i += 2;
    } else {
      is_in |= set[i] == character;
    }
  }
  return is_in != is_negated;
}

/// A pattern that begins with {left,right}: each of the words, then the rest.
bool matches_words(std::string_view pattern, std::string_view address, int& steps) {
  const auto end = pattern.find('}');
  if (end == pattern.npos) return false;
  auto words = pattern.substr(1, end - 1);
  while (--steps >= 0) {
    const auto word = words.substr(0, words.find(','));
    if (address.starts_with(word) &&
        matches(pattern.substr(end + 1), address.substr(word.size()), steps))
      return true;
    if (word.size() == words.size()) return false;
    words.remove_prefix(word.size() + 1);
  }
  return false;
}

}  // namespace

bool is_pattern(std::string_view address) {
  return address.find_first_of("?*[{") != std::string_view::npos;
}

// It calls itself for each * and {…}: as deep as the pattern is long, and no deeper than `steps`.
bool matches(std::string_view pattern, std::string_view address, int& steps) {
  while (!pattern.empty()) {
    if (--steps < 0) return false;
    const char sign = pattern.front();
    if (sign == '*') {
      while (pattern.starts_with('*')) pattern.remove_prefix(1);
      for (;; address.remove_prefix(1)) {
        if (matches(pattern, address, steps)) return true;
        if (steps < 0 || address.empty() || address.front() == '/') return false;
      }
    }
    if (sign == '{') return matches_words(pattern, address, steps);
    if (address.empty()) return false;
    if (sign == '[') {
      const auto end = pattern.find(']');
      if (end == pattern.npos || address.front() == '/' ||
          !is_in_set(pattern.substr(1, end - 1), address.front()))
        return false;
      pattern.remove_prefix(end);
    } else if (sign == '?' ? address.front() == '/' : sign != address.front()) {
      return false;
    }
    pattern.remove_prefix(1);
    address.remove_prefix(1);
  }
  return address.empty();
}

}  // namespace handcast::desk::osc
