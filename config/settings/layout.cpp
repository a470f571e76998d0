// SPDX-License-Identifier: Apache-2.0
#include "config/settings/layout.hpp"

#include <algorithm>

namespace handcast::config {
namespace {

using Path = Layout::Path;
using Span = Layout::Span;

constexpr std::string_view kBlank = " \t", kBlankAndLines = " \t\r\n";

/// Goes through a text once, from its beginning to its end.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  Layout scan() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte order mark
    layout_.containers.push_back({.path = {}, .at = {at_, at_}});
    std::size_t here = 0;
    for (skip_lines(); at_ < text_.size(); skip_lines()) {
      const auto before = at_;
      if (text_[at_] == '[')
        here = header();
      else
        entry(here);
      if (at_ == before) ++at_;  // no TOML
    }
    return std::move(layout_);
  }

 private:
  bool next_is(std::string_view token) const { return text_.substr(at_).starts_with(token); }
  bool take(std::string_view token) {
    if (!next_is(token)) return false;
    at_ += token.size();
    return true;
  }
  void skip(std::string_view characters) {
    at_ = std::min(text_.find_first_not_of(characters, at_), text_.size());
  }
  void skip_to(std::string_view characters) {
    at_ = std::min(text_.find_first_of(characters, at_), text_.size());
  }
  /// Blanks, ends of lines and comments.
  void skip_lines() {
    for (skip(kBlankAndLines); next_is("#"); skip(kBlankAndLines)) skip_to("\n");
  }

  /// A string behind its opening quotes; at_ is behind its closing ones.
  void text_until(std::string_view quotes) {
    const bool has_escapes = quotes.front() == '"';
    while (at_ < text_.size() && !next_is(quotes)) at_ += has_escapes && text_[at_] == '\\' ? 2 : 1;
    at_ = std::min(at_ + quotes.size(), text_.size());
    // Up to two quotes may stand before the closing three.
    if (quotes.size() == 3)
      for (int i = 0; i < 2 && next_is(quotes.substr(0, 1)); ++i) ++at_;
  }

  std::string key_part() {
    for (const std::string_view quote : {"\"", "'"}) {
      if (!take(quote)) continue;
      const auto begin = at_;
      text_until(quote);
      return std::string(text_.substr(begin, std::max(at_, begin + 1) - 1 - begin));
    }
    const auto begin = at_;
    skip_to(" \t\r\n.=]}#\"'");
    return std::string(text_.substr(begin, at_ - begin));
  }

  /// A key with dots, below `above`.
  Path key(Path above) {
    do {
      skip(kBlank);
      above.push_back(key_part());
      skip(kBlank);
    } while (take("."));
    return above;
  }

  /// "[a.b]" or "[[a.b]]". Returns the index of its container.
  std::size_t header() {
    const auto begin = at_;
    ++at_;
    const bool is_list = take("[");
    auto path = key({});
    take(is_list ? "]]" : "]");
    if (is_list) lists_.push_back(path);
    const bool in_list = std::ranges::any_of(lists_, [&](const Path& list) {
      return list.size() <= path.size() && std::equal(list.begin(), list.end(), path.begin());
    });
    layout_.containers.push_back(
        {Layout::Container::Kind::section, std::move(path), {begin, at_}, in_list});
    return layout_.containers.size() - 1;
  }

  /// "key = value" of a container.
  void entry(std::size_t container) {
    const auto begin = at_;
    auto path = key(layout_.containers[container].path);
    const Span key{begin, behind_last(begin, kBlank)};
    if (!take("=")) return;
    skip(kBlank);
    const auto index = layout_.entries.size();
    const bool in_list = layout_.containers[container].in_list;
    if (!in_list) layout_.entries.push_back({container, path, key, {}, line_of(begin)});
    const auto value_begin = at_;
    value(path, in_list);
    if (!in_list) layout_.entries[index].value = {value_begin, at_};
  }

  /// A value below `path`. Those in a list have no path of their own.
  void value(const Path& path, bool in_list) {
    for (const std::string_view quotes : {"\"\"\"", "'''", "\"", "'"})
      if (take(quotes)) return text_until(quotes);
    if (take("[")) return list(path);
    if (next_is("{")) return inline_table(path, in_list);
    const auto begin = at_;
    skip_to(",]}#\r\n");
    at_ = behind_last(begin, kBlank);
  }

  void list(const Path& path) {
    for (skip_lines(); at_ < text_.size() && !take("]"); skip_lines()) {
      const auto before = at_;
      value(path, true);
      skip_lines();
      take(",");
      if (at_ == before) ++at_;  // no TOML
    }
  }

  void inline_table(const Path& path, bool in_list) {
    const auto index = layout_.containers.size();
    layout_.containers.push_back(
        {Layout::Container::Kind::inline_table, path, {at_, at_}, in_list});
    ++at_;
    for (skip_lines(); at_ < text_.size() && !take("}"); skip_lines()) {
      const auto before = at_;
      entry(index);
      skip_lines();
      take(",");
      if (at_ == before) ++at_;  // no TOML
    }
    layout_.containers[index].at.end = at_;
  }

  /// Behind the last character since `begin` that is none of these.
  std::size_t behind_last(std::size_t begin, std::string_view characters) const {
    const auto last = text_.substr(begin, at_ - begin).find_last_not_of(characters);
    return last == std::string_view::npos ? begin : begin + last + 1;
  }

  int line_of(std::size_t at) {
    line_ += static_cast<int>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(counted_),
                                         text_.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted_ = at;
    return line_;
  }

  std::string_view text_;
  std::size_t at_ = 0, counted_ = 0;
  int line_ = 1;
  std::vector<Path> lists_;  ///< the paths of all [[ ]]
  Layout layout_;
};

}  // namespace

Layout layout_of(std::string_view toml) { return Scanner(toml).scan(); }

}  // namespace handcast::config
