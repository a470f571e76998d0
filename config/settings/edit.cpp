// SPDX-License-Identifier: Apache-2.0
#include "config/settings/edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "config/settings/document.hpp"
#include "config/settings/layout.hpp"
#include "ipc/base/join.hpp"

namespace handcast::config {
namespace {

using Path = Layout::Path;
using Kind = Layout::Container::Kind;

Path parts_of(std::string_view path) {
  Path parts(1);
  for (const char c : path) {
    if (c == '.')
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

bool is_below(const Path& path, const Path& above) {
  return path.size() > above.size() && std::equal(above.begin(), above.end(), path.begin());
}

Path first_of(const Path& path, std::size_t count) {
  return {path.begin(), path.begin() + static_cast<std::ptrdiff_t>(count)};
}

// Dates and times have no value here, but an edit leaves all others as they are.
bool is_same(const Value& a, const Value& b);

bool is_same(const OtherValue& /*a*/, const OtherValue& /*b*/) { return true; }
bool is_same(double a, double b) { return a == b || (a != a && b != b); }
bool is_same(const Array& a, const Array& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Value& x, const Value& y) { return is_same(x, y); });
}
/// In any order.
bool is_same(const Table& a, const Table& b) {
  return a.size() == b.size() && std::ranges::all_of(a, [&](const Member& member) {
           const auto other = std::ranges::find(b, member.name, &Member::name);
           return other != b.end() && is_same(member.value, other->value);
         });
}
template <class T>
bool is_same(const T& a, const T& b) {
  return a == b;
}

bool is_same(const Value& a, const Value& b) {
  return a.data.index() == b.data.index() &&
         std::visit(
             [&](const auto& inside) {
               return is_same(inside, std::get<std::decay_t<decltype(inside)>>(b.data));
             },
             a.data);
}

/// Sets a value in a document. False if a part of the path is no section.
bool set(Value& document, const Path& path, const Value& value) {
  auto* at = &document;
  for (const auto& name : path) {
    auto* table = std::get_if<Table>(&at->data);
    if (!table) return false;
    auto found = std::ranges::find(*table, name, &Member::name);
    if (found == table->end()) found = table->insert(found, Member{name, Value{Table{}, 0}});
    at = &found->value;
  }
  at->data = value.data;
  return true;
}

/// The edits of a text that may set a value, the most natural first. Not all of them need be valid.
class Editor {
 public:
  Editor(std::string_view text, const Path& path, std::string_view value)
      : text_(text), path_(path), value_(value), layout_(layout_of(text)) {}

  /// Where the setting is now.
  const Layout::Entry* entry() const {
    const auto found = std::ranges::find(layout_.entries, path_, &Layout::Entry::path);
    return found == layout_.entries.end() ? nullptr : &*found;
  }

  std::vector<std::string> candidates() const {
    if (const auto* there = entry()) return {replaced(there->value)};
    std::vector<std::string> texts;
    const auto section = first_of(path_, path_.size() - 1);
    for (const auto& container : layout_.containers)
      if (!container.in_list && container.path == section) texts.push_back(inserted(container));
    if (const auto* beside = dotted_beside(section)) texts.push_back(inserted_after(*beside));
    for (const auto& container : layout_.containers)
      if (container.kind == Kind::inline_table && !container.in_list &&
          is_below(section, container.path))
        texts.push_back(inserted(container));
    if (!section.empty())
      texts.push_back(fmt::format("{0}{1}[{2}]{1}{3}{1}", with_end(text_),
                                  end_of_line(text_.size()), join(section, "."),
                                  line_in(section.size())));
    return texts;
  }

 private:
  /// "latency_ms = 10.2", below the first `depth` parts of the path.
  std::string line_in(std::size_t depth) const {
    const Path rest(path_.begin() + static_cast<std::ptrdiff_t>(depth), path_.end());
    return fmt::format("{} = {}", join(rest, "."), value_);
  }

  std::string replaced(Layout::Span span) const {
    return fmt::format("{}{}{}", text_.substr(0, span.begin), value_, text_.substr(span.end));
  }
  std::string inserted_at(std::size_t at, std::string_view what) const {
    return fmt::format("{}{}{}", text_.substr(0, at), what, text_.substr(at));
  }

  /// As the line at this place ends; the last one without an end as the first line.
  std::string_view end_of_line(std::size_t at) const {
    auto end = text_.find('\n', at);
    if (end == std::string_view::npos) end = text_.find('\n');
    return end != std::string_view::npos && end > 0 && text_[end - 1] == '\r' ? "\r\n" : "\n";
  }
  std::string with_end(std::string_view text) const {
    const bool ends = text.empty() || text.back() == '\n';
    return fmt::format("{}{}", text, ends ? "" : end_of_line(text_.size()));
  }
  /// The blanks before what stands at this place, if nothing else does.
  std::string_view indent_of(std::size_t at) const {
    const auto newline = at == 0 ? std::string_view::npos : text_.rfind('\n', at - 1);
    const auto begin = newline == std::string_view::npos ? 0 : newline + 1;
    const auto indent = text_.substr(begin, at - begin);
    return indent.find_first_not_of(" \t") == std::string_view::npos ? indent : "";
  }
  /// A new line behind that of the character before `at`.
  std::string line_behind(std::size_t at, std::string_view indent, const std::string& line) const {
    const auto newline = text_.find('\n', at);
    const auto behind = newline == std::string_view::npos ? text_.size() : newline + 1;
    return fmt::format("{}{}{}{}{}", with_end(text_.substr(0, behind)), indent, line,
                       end_of_line(at), text_.substr(behind));
  }

  const Layout::Entry* first_in(const Layout::Container& container) const {
    const auto found = std::ranges::find_if(layout_.entries, [&](const Layout::Entry& entry) {
      return &layout_.containers[entry.container] == &container;
    });
    return found == layout_.entries.end() ? nullptr : &*found;
  }
  const Layout::Entry* last_in(const Layout::Container& container) const {
    const Layout::Entry* last = nullptr;
    for (const auto& entry : layout_.entries)
      if (&layout_.containers[entry.container] == &container) last = &entry;
    return last;
  }

  /// The setting as a new entry of a container.
  std::string inserted(const Layout::Container& container) const {
    const auto line = line_in(container.path.size());
    const auto* first = first_in(container);
    const auto* last = last_in(container);
    if (container.kind == Kind::inline_table) {
      if (last) return inserted_at(last->value.end, ", " + line);
      const bool is_wide = container.at.end - container.at.begin > 2;  // "{ }"
      return inserted_at(container.at.begin + 1, " " + line + (is_wide ? "" : " "));
    }
    if (container.kind == Kind::section)
      return line_behind(container.at.end, indent_of(first ? first->key.begin : container.at.begin),
                         line);
    if (last) return line_behind(last->value.end, indent_of(last->key.begin), line);
    return inserted_at(container.at.end, fmt::format("{0}{1}{1}", line, end_of_line(0)));
  }

  /// The last entry that makes the section by dots in its key: "projector.rate_hz = 60".
  const Layout::Entry* dotted_beside(const Path& section) const {
    const Layout::Entry* beside = nullptr;
    for (const auto& entry : layout_.entries)
      if (is_below(entry.path, section) &&
          is_below(section, layout_.containers[entry.container].path))
        beside = &entry;
    return beside;
  }
  std::string inserted_after(const Layout::Entry& beside) const {
    const auto& container = layout_.containers[beside.container];
    const auto line = line_in(container.path.size());
    if (container.kind == Kind::inline_table) return inserted_at(beside.value.end, ", " + line);
    return line_behind(beside.value.end, indent_of(beside.key.begin), line);
  }

  std::string_view text_;
  const Path& path_;
  std::string_view value_;
  Layout layout_;
};

/// The document as it should be; nothing if the value is not one, or its section is something else.
std::optional<Value> expected(Value document, const Path& path, const std::string& value) {
  const auto parsed = parse_document("value = " + value, "");
  if (!parsed) return std::nullopt;
  const auto& members = std::get<Table>(parsed->data);
  if (members.size() != 1 || !set(document, path, members.front().value)) return std::nullopt;
  return document;
}

}  // namespace

Result<std::string> with_value(const std::string& toml, const std::string& path,
                               const std::string& value, std::string_view file) {
  const auto before = parse_document(toml, file);
  if (!before) return tl::make_unexpected(before.error());
  const auto parts = parts_of(path);
  const Editor editor(toml, parts, value);
  if (const auto wanted = expected(*before, parts, value))
    for (auto& text : editor.candidates())
      if (const auto after = parse_document(text, file); after && is_same(*after, *wanted))
        return std::move(text);
  const auto* entry = editor.entry();
  return fail(Errc::bad_config,
              fmt::format("{}{}: this file cannot be edited without changing more than {}; write "
                          "by hand: {} = {}",
                          file, entry ? fmt::format(":{}", entry->line) : "", path, path, value));
}

}  // namespace handcast::config
