// SPDX-License-Identifier: Apache-2.0
#include "services/content/settable_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ipc/base/quote.hpp"

namespace handcast::content {

SettableSource::SettableSource(std::vector<Parameter> parameters)
    : parameters_(std::move(parameters)), texts_(parameters_.size()) {
  for (const Parameter& parameter : parameters_) values_.push_back(parameter.initial);
}

Result<void> SettableSource::set(std::string_view name, std::string_view value) {
  const auto index = index_of(name);
  if (index == parameters_.size()) return Source::set(name, value);
  const Parameter& parameter = parameters_[index];
  using Kind = Parameter::Kind;
  if (parameter.kind != Kind::text && parameter.kind != Kind::picture) {
    auto numbers = numbers_in_range(parameter, value);
    if (!numbers) return tl::make_unexpected(numbers.error());
    values_[index] = std::move(*numbers);
  }
  texts_[index] = value;
  has_changed_ = true;
  return {};
}

std::span<const double> SettableSource::numbers(std::string_view name) const {
  return values_[index_of(name)];
}

const std::string& SettableSource::text(std::string_view name) const {
  return texts_[index_of(name)];
}

std::size_t SettableSource::index_of(std::string_view name) const {
  const auto found = std::ranges::find(parameters_, name, &Parameter::name);
  return static_cast<std::size_t>(found - parameters_.begin());
}

Result<std::vector<double>> numbers_in_range(const Parameter& parameter, std::string_view text) {
  auto numbers = numbers_of(parameter, text);
  if (!numbers) return numbers;
  for (std::size_t i = 0; i < numbers->size(); ++i) {
    const double value = (*numbers)[i];
    const bool has_range = i < parameter.least.size() && i < parameter.most.size();
    const bool is_outside = has_range && (value < parameter.least[i] || value > parameter.most[i]);
    if (is_outside || !std::isfinite(value))
      return fail(Errc::bad_config,
                  has_range
                      ? fmt::format("{}: {} is out of range; it is {:g} to {:g}", parameter.name,
                                    quote(text), parameter.least[i], parameter.most[i])
                      : fmt::format("{}: {} is not a finite number", parameter.name, quote(text)));
  }
  return numbers;
}

Parameter number_parameter(std::string name, std::string label, double least, double most,
                           double initial) {
  Parameter parameter =
      plain_parameter(std::move(name), std::move(label), Parameter::Kind::number, {initial});
  parameter.least = {least};
  parameter.most = {most};
  return parameter;
}

Parameter choice_parameter(std::string name, std::string label, std::vector<std::string> choices,
                           double initial) {
  Parameter parameter =
      plain_parameter(std::move(name), std::move(label), Parameter::Kind::choice, {initial});
  for (std::size_t i = 0; i < choices.size(); ++i)
    parameter.values.push_back(static_cast<double>(i));
  parameter.least = {0};
  parameter.most = {static_cast<double>(choices.size()) - 1};
  parameter.choices = std::move(choices);
  return parameter;
}

Parameter plain_parameter(std::string name, std::string label, Parameter::Kind kind,
                          std::vector<double> initial) {
  Parameter parameter;
  parameter.name = std::move(name);
  parameter.label = std::move(label);
  parameter.kind = kind;
  parameter.initial = std::move(initial);
  return parameter;
}

}  // namespace handcast::content
