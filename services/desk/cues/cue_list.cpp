// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/cue_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "config/content_chain.hpp"
#include "config/settings/document.hpp"
#include "config/settings/files.hpp"
#include "config/settings/load.hpp"
#include "config/settings/quoted.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "services/desk/controls/control_value.hpp"
#include "services/desk/cues/trigger.hpp"

namespace handcast::desk::cues {
namespace {

using config::Table;
using config::Value;

constexpr std::size_t kMostCues = 1000;
constexpr double kLongestFade_s = 3600;

std::optional<double> as_number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*whole);
  const auto* number = std::get_if<double>(&value.data);
  return number ? std::optional(*number) : std::nullopt;
}

const Value* find_member(const Table& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &config::Member::name);
  return found == table.end() ? nullptr : &found->value;
}

/// Reads the document and collects what is wrong.
class CueReader {
 public:
  CueReader(std::string_view file, std::span<const Control> controls)
      : file_(file), controls_(controls) {}

  Result<CueList> read(const Value& document) {
    CueList list;
    for (const auto& [name, value] : std::get<Table>(document.data)) {
      if (name == "loop")
        read_into(value, name, list.loops);
      else if (name == "cue")
        read_all(value, list);
      else
        complain(value, fmt::format("there is no '{}'{}; there is loop and [[cue]]", name,
                                    suggest(name, {"loop", "cue"})));
    }
    if (list.cues.empty() && faults_.empty())
      complain(document, "it has no cue; begin one with [[cue]]");
    if (!faults_.empty()) return tl::make_unexpected(faults_.to_error());
    return list;
  }

 private:
  void complain(const Value& value, std::string_view sentence) {
    faults_.add(fmt::format("{}:{}: {}{}", file_, std::max(value.line, 1), where_, sentence));
  }

  void read_into(const Value& value, std::string_view name, bool& into) {
    if (const auto* flag = std::get_if<bool>(&value.data))
      into = *flag;
    else
      complain(value, fmt::format("{} must be true or false, not {}", name, kind_of(value)));
  }
  void read_into(const Value& value, std::string_view name, std::string& into) {
    if (const auto* text = std::get_if<std::string>(&value.data); text && !text->empty())
      into = *text;
    else
      complain(value, fmt::format("{} must be a text, not {}", name, kind_of(value)));
  }
  void read_fade(const Value& value, double& into) {
    const auto number = as_number(value);
    if (number && *number >= 0 && *number <= kLongestFade_s)
      into = *number;
    else
      complain(value, fmt::format("fade_s must be a number, 0..{} s", kLongestFade_s));
  }
  void read_curve(const Value& value, Curve& into) {
    constexpr std::array<std::string_view, 3> kCurves{"linear", "ease", "s-curve"};
    const auto* text = std::get_if<std::string>(&value.data);
    const auto found = text ? std::ranges::find(kCurves, *text) : kCurves.end();
    if (found == kCurves.end())
      return complain(value, "curve must be one of: linear, ease, s-curve");
    into = static_cast<Curve>(found - kCurves.begin());
  }

  void read_all(const Value& value, CueList& list) {
    const auto* array = std::get_if<config::Array>(&value.data);
    if (!array) return complain(value, "a cue begins with [[cue]], in two pairs of brackets");
    if (array->size() > kMostCues)
      return complain(
          value, fmt::format("{} cues are too many; the most is {}", array->size(), kMostCues));
    for (const auto& element : *array) {
      const auto* table = std::get_if<Table>(&element.data);
      if (!table) return complain(element, "a cue begins with [[cue]]");
      list.cues.push_back(read_cue(element, *table, list));
    }
  }

  Cue read_cue(const Value& value, const Table& table, const CueList& list) {
    Cue cue;
    cue.name = std::to_string(list.cues.size() + 1);
    where_ = fmt::format("cue {}: ", cue.name);
    if (const auto* name = find_member(table, "name")) read_into(*name, "name", cue.name);
    const bool is_taken = std::ranges::find(list.cues, cue.name, &Cue::name) != list.cues.end();
    if (is_taken)
      complain(value, fmt::format("its name {} is that of another cue", quote(cue.name)));
    fade_s_ = 0;
    curve_ = Curve::linear;
    if (const auto* fade = find_member(table, "fade_s")) read_fade(*fade, fade_s_);
    if (const auto* curve = find_member(table, "curve")) read_curve(*curve, curve_);
    for (const auto& [name, member] : table) read_member(name, member, cue);
    where_.clear();
    return cue;
  }

  void read_member(const std::string& name, const Value& value, Cue& cue) {
    constexpr std::array<std::string_view, 3> kDone{"name", "fade_s", "curve"};
    if (std::ranges::find(kDone, name) != kDone.end()) return;
    if (name == "left" || name == "right" || name == "both") {
      read_content(name, value, cue);
    } else if (name == "transition" || name == "transition_s") {
      read_switch("content." + name, value, cue);
    } else if (name == "on") {
      read_triggers(value, cue);
    } else if (name == "set") {
      read_targets("", value, cue);
    } else {
      complain(value,
               fmt::format("there is no '{}'{}", name,
                           suggest(name, {"name", "on", "left", "right", "both", "transition",
                                          "transition_s", "fade_s", "curve", "set"})));
    }
  }

  void read_content(const std::string& hand, const Value& value, Cue& cue) {
    std::string content;
    read_into(value, hand, content);
    if (content.empty()) return;
    const auto folder = std::filesystem::absolute(file_).parent_path();
    auto resolved = config::resolve_content(content, folder);
    if (resolved)
      cue.content.emplace_back(hand, std::move(*resolved));
    else
      complain(value, fmt::format("{}: {}", hand, resolved.error().what));
  }

  void read_triggers(const Value& value, Cue& cue) {
    const auto read_one = [&](const Value& one) {
      const auto* text = std::get_if<std::string>(&one.data);
      const auto trigger = read_trigger(text ? *text : "");
      if (trigger)
        cue.triggers.push_back(*trigger);
      else
        complain(one, "on: " + trigger.error().what);
    };
    if (const auto* list = std::get_if<config::Array>(&value.data))
      std::ranges::for_each(*list, read_one);
    else
      read_one(value);
  }

  /// The settings below a path: "light" is a section, "light.master" a setting.
  void read_targets(const std::string& path, const Value& value, Cue& cue) {
    const auto* table = std::get_if<Table>(&value.data);
    if (find_control(controls_, path)) {
      const auto* to = table ? find_member(*table, "to") : nullptr;
      if (!table) return read_target(path, value, cue, fade_s_, curve_);
      if (!to) return complain(value, fmt::format("{} needs `to`, its value", path));
      return read_spelled_out(path, *table, *to, cue);
    }
    if (!table) return complain_of_path(path, value);
    for (const auto& [name, member] : *table)
      read_targets(path.empty() ? name : fmt::format("{}.{}", path, name), member, cue);
  }

  void complain_of_path(const std::string& path, const Value& value) {
    if (path.empty())
      return complain(value, "set must be settings and their values: set.light.master = 0.5");
    std::vector<std::string_view> paths;
    for (const auto& control : controls_) paths.push_back(control.path);
    complain(value,
             fmt::format("there is no live setting {}{}", quote(path), suggest(path, paths)));
  }

  /// { to = 0.5, fade_s = 10, curve = "linear" }
  void read_spelled_out(const std::string& path, const Table& table, const Value& to, Cue& cue) {
    double fade_s = fade_s_;
    auto curve = curve_;
    for (const auto& [name, value] : table)
      if (name == "fade_s")
        read_fade(value, fade_s);
      else if (name == "curve")
        read_curve(value, curve);
      else if (name != "to")
        complain(value, fmt::format("{} has to, fade_s and curve, but no '{}'", path, name));
    read_target(path, to, cue, fade_s, curve);
  }

  /// A setting that does not fade: it is set before content is shown.
  void read_switch(const std::string& path, const Value& value, Cue& cue) {
    const auto before = cue.targets.size();
    read_target(path, value, cue, 0, Curve::linear);
    if (cue.targets.size() == before) return;
    auto& target = cue.targets.back();
    if (target.numbers.empty()) return;
    target.assignment = fmt::format("{}={}", path, print_number(target.numbers[0]));
    target.numbers.clear();
  }

  void read_target(const std::string& path, const Value& value, Cue& cue, double fade_s,
                   Curve curve) {
    const auto at = find_control(controls_, path);
    if (!at) return complain_of_path(path, value);
    const auto& control = controls_[*at];
    Target target{*at, {}, "", fade_s, curve};
    const auto* list = std::get_if<config::Array>(&value.data);
    const bool is_list = control.kind == Kind::numbers || control.kind == Kind::texts;
    if (is_list != (list != nullptr))
      return complain(value, fmt::format("{} must {}be a list", path, is_list ? "" : "not "));
    if (is_list && control.kind == Kind::texts) return read_texts(*list, control, cue, target);
    const auto elements = list ? *list : config::Array{value};
    for (const auto& element : elements)
      if (!read_element(element, control, target)) return;
    if (list && elements.size() != numbers_in(control.initial))
      return complain(
          value, fmt::format("{} must be a list of {} numbers", path, numbers_in(control.initial)));
    cue.targets.push_back(std::move(target));
  }

  static std::size_t numbers_in(std::string_view toml) {
    const auto value = read_value(toml);
    const auto* list = std::get_if<config::Array>(&value.data);
    return list ? list->size() : 1;
  }

  void read_texts(const config::Array& list, const Control& control, Cue& cue, Target& target) {
    std::string assignment;
    for (const auto& element : list) {
      const auto* text = std::get_if<std::string>(&element.data);
      if (!text) return complain(element, fmt::format("{} must be a list of texts", control.path));
      assignment += (assignment.empty() ? "" : ", ") + config::quoted(*text);
    }
    target.assignment = fmt::format("{}=[{}]", control.path, assignment);
    cue.targets.push_back(std::move(target));
  }

  /// A single value, or one of a list of numbers.
  bool read_element(const Value& value, const Control& control, Target& target) {
    const auto number = as_number(value);
    const auto* flag = std::get_if<bool>(&value.data);
    const auto* text = std::get_if<std::string>(&value.data);
    const bool is_toggle = control.kind == Kind::toggle;
    if (is_toggle != (flag != nullptr) || (!number && !flag && !text)) {
      complain(value,
               fmt::format("{} must {}be true or false", control.path, is_toggle ? "" : "not "));
      return false;
    }
    const auto assignment =
        text ? assign_text(control, *text) : assign_number(control, flag ? *flag : *number);
    if (!assignment) {
      complain(value, fmt::format("{}: {}", control.path, assignment.error().what));
      return false;
    }
    const bool is_number = control.kind == Kind::number || control.kind == Kind::whole ||
                           control.kind == Kind::numbers;
    if (is_number)
      target.numbers.push_back(*number);
    else
      target.assignment = *assignment;
    return true;
  }

  std::string_view file_;
  std::span<const Control> controls_;
  config::Faults faults_;
  std::string where_;  ///< "cue 3: "
  double fade_s_ = 0;  ///< of the cue that is being read
  Curve curve_ = Curve::linear;
};

}  // namespace

double progress(Curve curve, double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  switch (curve) {
    case Curve::ease:
      return 1 - (1 - t) * (1 - t);
    case Curve::s_curve:
      return t * t * (3 - 2 * t);
    case Curve::linear:
      break;
  }
  return t;
}

double Cue::longest_fade_s() const {
  double longest = 0;
  for (const auto& target : targets)
    if (!target.numbers.empty()) longest = std::max(longest, target.fade_s);
  return longest;
}

Result<CueList> parse_cues(const std::string& toml, std::string_view file,
                           std::span<const Control> controls) {
  const auto document = config::parse_document(toml, file);
  if (!document) return tl::make_unexpected(document.error());
  return CueReader(file, controls).read(*document);
}

Result<CueList> read_cues(const std::filesystem::path& file, std::span<const Control> controls) {
  const auto text = config::read_text(file);
  if (!text) return tl::make_unexpected(text.error());
  return parse_cues(*text, file.string(), controls);
}

}  // namespace handcast::desk::cues
