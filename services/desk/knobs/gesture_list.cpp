// SPDX-License-Identifier: Apache-2.0
#include "services/desk/knobs/gesture_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/settings/document.hpp"
#include "config/settings/files.hpp"
#include "config/settings/load.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/suggest.hpp"
#include "services/desk/controls/control_value.hpp"

namespace handcast::desk::knobs {
namespace {

using config::Table;
using config::Value;

constexpr std::size_t kMostGestures = 64;
constexpr double kLongest_s = 60;
constexpr std::array<std::string_view, 9> kAmounts{"there", "pinch",   "spread", "fist", "open",
                                                   "point", "palm_up", "speed",  "touch"};
constexpr std::array<std::string_view, 3> kHands{"left", "right", "either"};
constexpr std::array<std::string_view, 3> kCurves{"linear", "ease", "s-curve"};
constexpr std::array<std::string_view, 2> kGone{"hold", "return"};

double amount_of(const Gesture& hand, Amount amount) {
  switch (amount) {
    case Amount::there:
      return 1;
    case Amount::pinch:
      return hand.pinch;
    case Amount::spread:
      return hand.spread;
    case Amount::fist:
      return hand.fist;
    case Amount::open:
      return 1 - hand.fist;
    case Amount::point:
      return hand.is_pointing;
    case Amount::palm_up:
      return hand.palm_up;
    case Amount::speed:
      return hand.speed_m_s;
    case Amount::touch:
      return hand.touches_other;
  }
  return 0;
}

std::optional<Source> read_source(std::string_view text) {
  if (text == "nobody") return Source{Source::Whose::nobody, Amount::there};
  const auto dot = text.find('.');
  if (dot == text.npos) return std::nullopt;
  const auto hand = std::ranges::find(kHands, text.substr(0, dot));
  const auto amount = std::ranges::find(kAmounts, text.substr(dot + 1));
  if (hand == kHands.end() || amount == kAmounts.end()) return std::nullopt;
  return Source{static_cast<Source::Whose>(hand - kHands.begin()),
                static_cast<Amount>(amount - kAmounts.begin())};
}

std::optional<double> as_number(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*whole);
  const auto* number = std::get_if<double>(&value.data);
  return number && std::isfinite(*number) ? std::optional(*number) : std::nullopt;
}

/// Reads the document and collects what is wrong.
class GestureReader {
 public:
  GestureReader(std::string_view file, std::span<const Control> controls)
      : file_(file), controls_(controls) {}

  Result<std::vector<GestureKnob>> read(const Value& document) {
    for (const auto& [name, value] : std::get<Table>(document.data)) {
      if (name != "gesture") {
        complain(value, fmt::format("there is no '{}'; there is [[gesture]]", name));
        continue;
      }
      const auto* array = std::get_if<config::Array>(&value.data);
      if (!array) {
        complain(value, "a gesture begins with [[gesture]], in two pairs of brackets");
        continue;
      }
      if (array->size() > kMostGestures)
        complain(value, fmt::format("{} gestures are too many; the most is {}", array->size(),
                                    kMostGestures));
      for (const auto& element : *array)
        if (const auto* table = std::get_if<Table>(&element.data))
          read_one(element, *table);
        else
          complain(element, "a gesture is a table, [[gesture]]");
    }
    if (faults_.empty()) return std::move(knobs_);
    std::ranges::stable_sort(faults_, {}, &Fault::first);
    config::Faults sorted;
    for (auto& [line, sentence] : faults_) sorted.add(std::move(sentence));
    return tl::make_unexpected(sorted.to_error());
  }

 private:
  using Fault = std::pair<int, std::string>;  ///< its line and its sentence

  void complain(const Value& value, std::string_view sentence) {
    const int line = std::max(value.line, 1);
    faults_.emplace_back(line, fmt::format("{}:{}: {}", file_, line, sentence));
  }
  static const Value* find(const Table& table, std::string_view name) {
    const auto found = std::ranges::find(table, name, &config::Member::name);
    return found == table.end() ? nullptr : &found->value;
  }
  std::string read_text(const Value& at, const Table& table, std::string_view name) {
    const auto* value = find(table, name);
    const auto* text = value ? std::get_if<std::string>(&value->data) : nullptr;
    if (!text || text->empty())
      complain(value ? *value : at, fmt::format("a gesture needs {}, a text", name));
    return text ? *text : "";
  }
  void read_number(const Table& table, std::string_view name, double min, double max,
                   double& into) {
    const auto* value = find(table, name);
    if (!value) return;
    const auto number = as_number(*value);
    if (number && *number >= min && *number <= max)
      into = *number;
    else
      complain(*value, fmt::format("{} must be a number, {}..{}", name, min, max));
  }
  template <std::size_t N>
  std::size_t read_word(const Table& table, std::string_view name,
                        const std::array<std::string_view, N>& words) {
    const auto* value = find(table, name);
    if (!value) return 0;
    const auto* text = std::get_if<std::string>(&value->data);
    const auto found = text ? std::ranges::find(words, *text) : words.end();
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    complain(*value, fmt::format("{} must be one of: {}", name, join(words, ", ")));
    return 0;
  }

  void read_one(const Value& at, const Table& table) {
    constexpr std::array<std::string_view, 9> kNames{"path", "source", "from",     "to",  "min",
                                                     "max",  "curve",  "smooth_s", "gone"};
    for (const auto& [name, value] : table)
      if (std::ranges::find(kNames, name) == kNames.end())
        complain(value, fmt::format("there is no '{}'{}", name,
                                    suggest(name, {kNames.begin(), kNames.end()})));
    GestureKnob knob;
    const bool has_control = read_control(at, table, knob), has_source = read_way(at, table, knob);
    knob.curve = static_cast<cues::Curve>(read_word(table, "curve", kCurves));
    knob.returns = read_word(table, "gone", kGone) == 1;
    read_number(table, "smooth_s", 0, kLongest_s, knob.smooth_s);
    if (has_control && has_source) knobs_.push_back(std::move(knob));
  }

  bool read_control(const Value& at, const Table& table, GestureKnob& knob) {
    const auto path = read_text(at, table, "path");
    if (path.empty()) return false;
    const auto& where = *find(table, "path");
    const auto found = find_control(controls_, path);
    if (!found) {
      std::vector<std::string_view> paths;
      for (const auto& control : controls_) paths.push_back(control.path);
      complain(where,
               fmt::format("there is no live setting {}{}", quote(path), suggest(path, paths)));
      return false;
    }
    const bool is_taken = std::ranges::find(knobs_, *found, &GestureKnob::control) != knobs_.end();
    if (is_taken) complain(where, fmt::format("{} is turned by another gesture already", path));
    knob.control = *found;
    return read_values(where, table, controls_[*found], knob) && !is_taken;
  }

  /// The values at the ends of the way.
  bool read_values(const Value& where, const Table& table, const Control& control,
                   GestureKnob& knob) {
    auto range = control.range;
    if (control.kind == Kind::toggle) range = {0, 1, ""};
    if (control.kind == Kind::choice)
      range = {0, static_cast<double>(control.words.size()) - 1, ""};
    const bool is_number = control.kind == Kind::number || control.kind == Kind::whole;
    if (!is_number && control.kind != Kind::toggle && control.kind != Kind::choice) {
      complain(where, fmt::format("{} is not one number, switch or word, so no hand can turn it",
                                  control.path));
      return false;
    }
    knob.first = range.min;
    knob.last = range.max;
    read_number(table, "min", range.min, range.max, knob.first);
    read_number(table, "max", range.min, range.max, knob.last);
    if (!std::isfinite(knob.first) || !std::isfinite(knob.last)) {
      complain(where,
               fmt::format("{} has no range of its own: min and max are needed", control.path));
      return false;
    }
    const bool is_whole =
        std::floor(knob.first) == knob.first && std::floor(knob.last) == knob.last;
    if (control.kind != Kind::number && !is_whole) {
      complain(where, fmt::format("{} needs whole numbers as min and max", control.path));
      return false;
    }
    if (control.kind != Kind::number)
      knob.steps = static_cast<std::size_t>(std::abs(knob.last - knob.first)) + 1;
    return true;
  }

  /// The source and the part of its amounts that is used.
  bool read_way(const Value& at, const Table& table, GestureKnob& knob) {
    knob.source_name = read_text(at, table, "source");
    if (knob.source_name.empty()) return false;
    const auto source = read_source(knob.source_name);
    if (!source) {
      complain(*find(table, "source"),
               fmt::format("{} is nothing that a hand does; write left, right or either, a dot, "
                           "and one of: {}; or \"nobody\"",
                           quote(knob.source_name), join(kAmounts, ", ")));
      return false;
    }
    knob.source = *source;
    if (source->amount == Amount::palm_up) knob.from = -1;
    read_number(table, "from", -1, 10, knob.from);
    read_number(table, "to", -1, 10, knob.to);
    if (knob.from != knob.to) return true;
    complain(*find(table, "source"), "from and to must not be the same");
    return false;
  }

  std::string_view file_;
  std::span<const Control> controls_;
  std::vector<Fault> faults_;
  std::vector<GestureKnob> knobs_;
};

}  // namespace

std::optional<double> Source::at(const Scene& scene) const {
  const auto& [left, right] = scene.gestures;
  const auto of = [this](const Gesture& hand) {
    return hand.is_there ? std::optional(amount_of(hand, amount)) : std::nullopt;
  };
  switch (whose) {
    case Whose::left:
      return of(left);
    case Whose::right:
      return of(right);
    case Whose::either:
      return std::max(of(left), of(right));  // an empty one is the smaller
    case Whose::nobody:
      break;
  }
  return left.is_there || right.is_there ? std::nullopt : std::optional(1.0);
}

Result<std::vector<GestureKnob>> parse_gestures(const std::string& toml, std::string_view file,
                                                std::span<const Control> controls) {
  const auto document = config::parse_document(toml, file);
  if (!document) return tl::make_unexpected(document.error());
  return GestureReader(file, controls).read(*document);
}

Result<std::vector<GestureKnob>> read_gestures(const std::filesystem::path& file,
                                               std::span<const Control> controls) {
  const auto text = config::read_text(file);
  if (!text) return tl::make_unexpected(text.error());
  return parse_gestures(*text, file.string(), controls);
}

}  // namespace handcast::desk::knobs
