// SPDX-License-Identifier: Apache-2.0
#include "config/settings/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"

namespace handcast::config {
namespace {

constexpr std::size_t kLongestPath = 200;  ///< bytes of the name of a setting in a message

/// The problem with a value; empty if there is none.
using Complaint = std::string;

Complaint outside(double number, const Setting& setting) {
  if (number >= setting.range.min && number <= setting.range.max) return {};
  return fmt::format("{} is outside {}", number, print_allowed(setting));
}

/// E.g. "must be a number, 1..2000 Hz".
Complaint expected(const Setting& setting) {
  constexpr std::string_view kKinds[] = {"true or false",   "a whole number",    "a number",
                                         "text in quotes",  "a list of numbers", "a list of texts",
                                         "a word in quotes"};
  const auto allowed = print_allowed(setting);
  return fmt::format("must be {}{}{}", kKinds[setting.target.index()], allowed.empty() ? "" : ", ",
                     allowed);
}

/// A number in quotes.
std::string number_meant_by(std::string_view text) {
  if (auto meant = meant_number(text); !meant.empty()) return meant;
  return !text.empty() && text.find_first_not_of("0123456789.") == text.npos
             ? fmt::format("write {}, without quotes", text)
             : "";
}

Complaint wrong_kind(const Value& value, const Setting& setting) {
  const auto* text = std::get_if<std::string>(&value.data);
  const auto& target = setting.target;
  const bool wants_number = std::holds_alternative<int*>(target) ||
                            std::holds_alternative<double*>(target) ||
                            std::holds_alternative<std::vector<double>*>(target);
  const auto meant = text && wants_number ? number_meant_by(*text) : "";
  return fmt::format("{}, not {}{}{}", expected(setting), kind_of(value), meant.empty() ? "" : "; ",
                     meant);
}

std::optional<double> number_in(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*whole);
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  return std::nullopt;
}

Complaint store(bool& target, const Value& value, const Setting& setting) {
  const auto* flag = std::get_if<bool>(&value.data);
  if (!flag) return wrong_kind(value, setting);
  target = *flag;
  return {};
}

Complaint store(int& target, const Value& value, const Setting& setting) {
  const auto* whole = std::get_if<std::int64_t>(&value.data);
  if (!whole) return wrong_kind(value, setting);
  if (auto complaint = outside(static_cast<double>(*whole), setting); !complaint.empty())
    return complaint;
  if (!std::in_range<int>(*whole)) return fmt::format("{} is too large", *whole);
  target = static_cast<int>(*whole);
  return {};
}

Complaint store(double& target, const Value& value, const Setting& setting) {
  const auto number = number_in(value);
  if (!number) return wrong_kind(value, setting);
  if (!std::isfinite(*number)) return fmt::format("{} is not a finite number", *number);
  if (auto complaint = outside(*number, setting); !complaint.empty()) return complaint;
  target = *number;
  return {};
}

Complaint store(std::string& target, const Value& value, const Setting& setting) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (!text) return wrong_kind(value, setting);
  target = *text;
  return {};
}

Complaint store(const ChoiceTarget& target, const Value& value, const Setting& setting) {
  const auto* text = std::get_if<std::string>(&value.data);
  if (!text) return wrong_kind(value, setting);
  const auto found = std::ranges::find(target.words, *text);
  if (found == target.words.end())
    return fmt::format("{} is not {}{}", quote(*text), print_allowed(setting),
                       suggest(*text, target.words));
  target.assign(target.value, static_cast<std::size_t>(found - target.words.begin()));
  return {};
}

/// A list with default elements must keep its length.
Complaint store(std::vector<double>& target, const Value& value, const Setting& setting) {
  const auto* array = std::get_if<Array>(&value.data);
  if (!array) return wrong_kind(value, setting);
  if (!target.empty() && array->size() != target.size())
    return fmt::format("must be a list of {} numbers, not of {}", target.size(), array->size());
  std::vector<double> numbers(array->size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (auto complaint = store(numbers[i], (*array)[i], setting); !complaint.empty())
      return complaint;
  target = std::move(numbers);
  return {};
}

Complaint store(std::vector<std::string>& target, const Value& value, const Setting& setting) {
  const auto* array = std::get_if<Array>(&value.data);
  if (!array) return wrong_kind(value, setting);
  std::vector<std::string> texts(array->size());
  for (std::size_t i = 0; i < texts.size(); ++i)
    if (auto complaint = store(texts[i], (*array)[i], setting); !complaint.empty())
      return complaint;
  target = std::move(texts);
  return {};
}

template <class T>
Complaint store(T* target, const Value& value, const Setting& setting) {
  return store(*target, value, setting);
}

Complaint store(const Value& value, const Setting& setting) {
  return std::visit([&](const auto& target) { return store(target, value, setting); },
                    setting.target);
}

const Section* find_section(const Listing& listing, std::string_view path) {
  const auto found = std::find_if(listing.begin(), listing.end(),
                                  [&](const Section& section) { return section.path == path; });
  return found == listing.end() ? nullptr : &*found;
}

/// The names that are allowed in a section: its settings and the sections directly inside it.
std::vector<std::string_view> names_in(const Listing& listing, const Section& section) {
  std::vector<std::string_view> names;
  for (const auto& setting : section.settings) names.push_back(setting.name());
  const std::string prefix = section.path.empty() ? "" : section.path + ".";
  for (const auto& other : listing) {
    const std::string_view path = other.path;
    if (path.size() <= prefix.size() || !path.starts_with(prefix)) continue;
    if (path.find('.', prefix.size()) == path.npos) names.push_back(path.substr(prefix.size()));
  }
  return names;
}

/// Suggests a setting of the same name in another section.
std::string suggest_elsewhere(const Listing& listing, std::string_view name) {
  for (const auto& section : listing)
    for (const auto& setting : section.settings)
      if (setting.name() == name) return fmt::format(" (did you mean '{}'?)", setting.path);
  return {};
}

std::string unknown(const Listing& listing, const Section& section, std::string_view name) {
  auto hint = suggest(name, names_in(listing, section));
  if (hint.empty()) hint = suggest_elsewhere(listing, name);
  return fmt::format("there is no such setting{}", hint);
}

/// Walks through a document, and matches its tables with sections and its values with settings.
class Applier {
 public:
  Applier(std::string_view file, const Listing& listing, Faults& faults)
      : file_(file), listing_(listing), faults_(faults) {}

  void table(const Table& table, const Section& section) {
    for (const auto& [name, value] : table) {
      const auto path = section.path.empty() ? name : section.path + "." + name;
      if (const auto* inner = find_section(listing_, path)) {
        if (const auto* members = std::get_if<Table>(&value.data)) {
          this->table(*members, *inner);
        } else {
          complain(value, path,
                   fmt::format("is a section, [{}], and cannot be {}", path, kind_of(value)));
        }
      } else if (const auto* setting = find_setting(listing_, path)) {
        complain(value, path, store(value, *setting));
      } else {
        complain(value, path, unknown(listing_, section, name));
      }
    }
  }

 private:
  void complain(const Value& value, std::string_view path, const Complaint& complaint) {
    if (!complaint.empty())
      faults_.add(fmt::format("{}:{}: {}: {}", file_, value.line, shown_line(path, kLongestPath),
                              complaint));
  }

  std::string_view file_;
  const Listing& listing_;
  Faults& faults_;
};

std::string unknown_path(const Listing& listing, std::string_view path) {
  std::vector<std::string_view> paths;
  for (const auto& section : listing)
    for (const auto& setting : section.settings) paths.push_back(setting.path);
  auto hint = suggest(path, paths);
  if (hint.empty()) hint = suggest_elsewhere(listing, path.substr(path.rfind('.') + 1));
  return fmt::format("there is no such setting{}", hint);
}

/// Parses the value of an assignment: text without quotes is taken literally, also as the only
/// element of a list of texts; everything else is TOML. Empty if it is not valid TOML.
std::optional<Value> read_assigned(std::string_view text, const Target& target) {
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  const bool is_text =
      std::holds_alternative<std::string*>(target) || std::holds_alternative<ChoiceTarget>(target);
  if (is_text && !quoted) return Value{std::string(text), 1};
  if (std::holds_alternative<std::vector<std::string>*>(target) && !text.starts_with('['))
    return Value{Array{Value{std::string(text), 1}}, 1};
  const bool bare_list =
      std::holds_alternative<std::vector<double>*>(target) && !text.starts_with('[');
  const auto document = parse_document(
      fmt::format("value = {}{}{}", bare_list ? "[" : "", text, bare_list ? "]" : ""), "");
  if (!document) return std::nullopt;
  return std::get<Table>(document->data).front().value;
}

}  // namespace

Error Faults::to_error() const {
  constexpr std::size_t kMost = 100;  // a file of another kind is not printed back whole
  if (sentences_.size() <= kMost) return {Errc::bad_config, join(sentences_, "\n")};
  const std::vector first(sentences_.begin(), sentences_.begin() + kMost);
  return {Errc::bad_config,
          fmt::format("{}\nand {} more errors", join(first, "\n"), sentences_.size() - kMost)};
}

void apply_document(const Value& document, std::string_view file, const Listing& listing,
                    Faults& faults) {
  Applier(file, listing, faults).table(std::get<Table>(document.data), listing.front());
}

void apply_assignment(std::string_view assignment, const Listing& listing, Faults& faults) {
  const auto complain = [&](std::string_view sentence) {
    faults.add(fmt::format("--set {}: {}", shown_line(assignment, kLongestPath), sentence));
  };
  const auto equals = assignment.find('=');
  if (equals == assignment.npos) return complain("must look like path=value");
  const auto path = assignment.substr(0, equals), text = assignment.substr(equals + 1);
  if (assignment.find_first_of("\n\r") != assignment.npos)
    return complain("must not contain a line break");
  if (find_section(listing, path)) return complain("is a section; set one of its settings");
  const auto* setting = find_setting(listing, path);
  if (!setting) return complain(unknown_path(listing, path));
  const auto value = read_assigned(text, setting->target);
  const auto meant = value ? "" : meant_number(text);
  const auto complaint =
      value ? store(*value, *setting) : expected(*setting) + (meant.empty() ? "" : "; " + meant);
  if (!complaint.empty()) complain(complaint);
}

}  // namespace handcast::config
