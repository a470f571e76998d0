// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/fades.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ipc/base/join.hpp"
#include "services/desk/controls/control_value.hpp"

namespace handcast::desk::cues {
namespace {

/// The number, or the numbers, of a value.
std::vector<double> numbers_of(const Control& control, std::string_view toml) {
  if (control.kind != Kind::numbers) return {number_of(control, toml).value_or(0)};
  std::vector<double> numbers;
  const auto value = read_value(toml);
  if (const auto* list = std::get_if<config::Array>(&value.data))
    for (const auto& element : *list) {
      const auto* whole = std::get_if<std::int64_t>(&element.data);
      const auto* number = std::get_if<double>(&element.data);
      numbers.push_back(whole ? static_cast<double>(*whole) : number ? *number : 0);
    }
  return numbers;
}

std::string print_assignment(const Control& control, const std::vector<double>& numbers) {
  if (control.kind != Kind::numbers)
    return fmt::format("{}={}", control.path, print_number(numbers[0]));
  std::vector<std::string> texts;
  texts.reserve(numbers.size());
  for (const double number : numbers) texts.push_back(print_number(number));
  return fmt::format("{}=[{}]", control.path, join(texts, ", "));
}

}  // namespace

void Fades::begin(const Cue& cue, std::span<const Control> controls, const Values& values) {
  fades_.clear();
  for (const auto& target : cue.targets) {
    if (target.numbers.empty()) continue;
    auto from = numbers_of(controls[target.control], values.toml[target.control]);
    if (from.size() != target.numbers.size()) from = target.numbers;
    fades_.push_back({&target, from, from, from, false});
  }
}

std::vector<std::string> Fades::at(double elapsed_s, std::span<const Control> controls,
                                   const Values& values, std::string_view source) {
  std::erase_if(fades_, [&](const Fade& fade) {
    const auto control = fade.target->control;
    return values.source != source &&
           numbers_of(controls[control], values.toml[control]) != fade.set;
  });
  std::vector<std::string> assignments;
  for (auto& fade : fades_) {
    const auto& target = *fade.target;
    const auto& control = controls[target.control];
    const double share = target.fade_s > 0 ? elapsed_s / target.fade_s : 1;
    const double part = progress(target.curve, share);
    fade.has_arrived = share >= 1;
    for (std::size_t i = 0; i < fade.from.size(); ++i) {
      const double number = fade.from[i] + part * (target.numbers[i] - fade.from[i]);
      fade.asked[i] = share >= 1                    ? target.numbers[i]
                      : control.kind == Kind::whole ? std::round(number)
                                                    : number;
    }
    assignments.push_back(print_assignment(control, fade.asked));
  }
  return assignments;
}

void Fades::were_set() {
  for (auto& fade : fades_) fade.set = fade.asked;
  std::erase_if(fades_, [](const Fade& fade) { return fade.has_arrived; });
}

}  // namespace handcast::desk::cues
