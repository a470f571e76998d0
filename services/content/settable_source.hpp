// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "services/content/source.hpp"

namespace handcast::content {

/// A source with a fixed list of parameters.
class SettableSource : public Source {
 public:
  std::span<const Parameter> parameters() const override { return parameters_; }
  /// Errors (bad_config): as Source::set().
  Result<void> set(std::string_view name, std::string_view value) override;

 protected:
  explicit SettableSource(std::vector<Parameter> parameters);

  /// The value of a parameter that is in the list.
  /// @{
  double number(std::string_view name) const { return numbers(name)[0]; }
  std::span<const double> numbers(std::string_view name) const;
  const std::string& text(std::string_view name) const;  ///< "" until it is set
  /// @}
  /// True after the opening and after each change, once.
  bool take_change() { return std::exchange(has_changed_, false); }

 private:
  std::size_t index_of(std::string_view name) const;

  std::vector<Parameter> parameters_;
  std::vector<std::vector<double>> values_;
  std::vector<std::string> texts_;
  bool has_changed_ = true;
};

/// numbers_of(), within the range of the parameter. Errors (bad_config): not its value, out of
/// range.
Result<std::vector<double>> numbers_in_range(const Parameter& parameter, std::string_view text);

/// Parameters, for lists of them.
/// @{
Parameter number_parameter(std::string name, std::string label, double least, double most,
                           double initial);
Parameter choice_parameter(std::string name, std::string label, std::vector<std::string> choices,
                           double initial = 0);
Parameter plain_parameter(std::string name, std::string label, Parameter::Kind kind,
                          std::vector<double> initial = {});
/// @}

}  // namespace handcast::content
