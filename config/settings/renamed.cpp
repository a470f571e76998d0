// SPDX-License-Identifier: Apache-2.0
#include "config/settings/renamed.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast::config {
namespace {

const Renamed* row_of(std::span<const Renamed> table, std::string_view setting,
                      std::string_view value) {
  const auto row = std::ranges::find_if(table, [&](const Renamed& each) {
    return each.old.setting == setting && (each.old.value.empty() || each.old.value == value);
  });
  return row == table.end() ? nullptr : &*row;
}

std::string print(const Renamed::Form& form) {
  return form.value.empty() ? std::string(form.setting)
                            : fmt::format("{} = \"{}\"", form.setting, form.value);
}

/// "landmarks.backend = "own" is now "handcast"".
std::string sentence_of(const Renamed& row) {
  const bool same_setting = row.old.setting == row.now.setting;
  auto sentence = fmt::format("{} is now {}", print(row.old),
                              same_setting ? fmt::format("\"{}\"", row.now.value) : print(row.now));
  if (!row.also.setting.empty()) sentence += " with " + print(row.also);
  return sentence;
}

Table::iterator member_of(Table& table, std::string_view name) {
  return std::ranges::find(table, name, &Member::name);
}

/// A path as its first name and the rest; the rest of the last name is empty.
std::pair<std::string_view, std::string_view> split(std::string_view path) {
  const auto dot = path.find('.');
  return dot == path.npos ? std::pair(path, std::string_view())
                          : std::pair(path.substr(0, dot), path.substr(dot + 1));
}

/// The value at a path; null if there is none.
Value* value_at(Table& table, std::string_view path) {
  const auto [name, rest] = split(path);
  const auto member = member_of(table, name);
  if (member == table.end()) return nullptr;
  if (rest.empty()) return &member->value;
  auto* section = std::get_if<Table>(&member->value.data);
  return section ? value_at(*section, rest) : nullptr;
}

/// Removes the value at a path, which is there, and sections that become empty.
void remove(Table& table, std::string_view path) {
  const auto [name, rest] = split(path);
  const auto member = member_of(table, name);
  if (!rest.empty()) {
    auto& section = std::get<Table>(member->value.data);
    remove(section, rest);
    if (!section.empty()) return;
  }
  table.erase(member);
}

/// Members stay in the order of their lines.
Value& insert(Table& table, std::string_view name, Value value) {
  const auto at = std::ranges::upper_bound(table, value.line, {},
                                           [](const Member& each) { return each.value.line; });
  return table.insert(at, {std::string(name), std::move(value)})->value;
}

/// Adds a value, unless there is one. A member of the path that is not a section stays; the loader
/// complains about it.
void add(Table& table, std::string_view path, const Value& value) {
  const auto [name, rest] = split(path);
  const auto member = member_of(table, name);
  if (rest.empty()) {
    if (member == table.end()) insert(table, name, value);
    return;
  }
  auto& section =
      member == table.end() ? insert(table, name, {Table{}, value.line}) : member->value;
  if (auto* members = std::get_if<Table>(&section.data)) add(*members, rest, value);
}

/// Text of the file, at the line of what it replaces.
Value text_at(int line, std::string_view text) { return {std::string(text), line}; }

void replace(Table& table, const Renamed& row, const Value& old) {
  const auto now = row.now.value.empty() ? old : text_at(old.line, row.now.value);
  if (row.old.setting == row.now.setting) {
    *value_at(table, row.now.setting) = now;
  } else {
    remove(table, row.old.setting);
    add(table, row.now.setting, now);
  }
  if (!row.also.setting.empty()) add(table, row.also.setting, text_at(old.line, row.also.value));
}

}  // namespace

std::vector<Assignment> current_form(const Assignment& assignment, std::string_view where,
                                     std::span<const Renamed> table, const OnRenamed& on_renamed) {
  const auto* row = row_of(table, assignment.setting, assignment.value);
  if (!row) return {assignment};
  on_renamed(fmt::format("{}: {}", where, sentence_of(*row)));
  std::vector<Assignment> current{
      {std::string(row->now.setting),
       row->now.value.empty() ? assignment.value : std::string(row->now.value)}};
  if (!row->also.setting.empty())
    current.push_back({std::string(row->also.setting), std::string(row->also.value)});
  return current;
}

void replace_renamed(Value& document, std::string_view file, std::span<const Renamed> table,
                     const OnRenamed& on_renamed) {
  auto& root = std::get<Table>(document.data);
  for (const auto& row : table) {
    const auto* value = value_at(root, row.old.setting);
    if (!value) continue;
    const auto* word = std::get_if<std::string>(&value->data);
    if (!row.old.value.empty() && (!word || *word != row.old.value)) continue;
    on_renamed(fmt::format("{}:{}: {}", file, value->line, sentence_of(row)));
    replace(root, row, Value(*value));
  }
}

std::vector<std::string> replace_renamed(const std::string& assignment,
                                         std::span<const Renamed> table,
                                         const OnRenamed& on_renamed) {
  const auto equals = assignment.find('=');
  if (equals == assignment.npos) return {assignment};
  const std::string setting = assignment.substr(0, equals), value = assignment.substr(equals + 1);
  const bool quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
  const auto* row = row_of(table, setting, quoted ? value.substr(1, value.size() - 2) : value);
  if (!row) return {assignment};
  std::vector<std::string> current;
  const std::string word = row->old.value.empty() ? value : std::string(row->old.value);
  for (const auto& each : current_form({setting, word}, "--set", table, on_renamed))
    current.push_back(each.setting + "=" + each.value);
  return current;
}

}  // namespace handcast::config
