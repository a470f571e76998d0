// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"

namespace handcast::content::shader {

/// An arithmetic expression of an ISF head, e.g. "floor($WIDTH / max($blur, 1.0))": numbers, names
/// after a "$", + - * / % ^, parentheses, comparisons, && and ||, a ? b : c, and the usual
/// functions.
class Expression {
 public:
  /// The value of a name without its "$"; empty if there is none.
  using Lookup = std::function<std::optional<double>(std::string_view name)>;

  /// An expression with a value of its own.
  explicit Expression(double value = 0) : steps_{{Step::Kind::number, value, {}}} {}
  /// Reads it. Errors (bad_config), as the end of a sentence that begins with what it is for:
  /// "has no ')' after ...".
  static Result<Expression> parse(std::string_view text);

  /// The names that it needs.
  std::vector<std::string> names() const;
  /// Its value. A name without a value is 0.
  double value(const Lookup& lookup) const;

 private:
  friend class ExpressionParser;
  struct Step {
    enum class Kind { number, name, call };
    Kind kind;
    double number;     ///< of a call: the index of its function
    std::string name;  ///< of a name
  };
  std::vector<Step> steps_;  ///< in postfix order
};

}  // namespace handcast::content::shader
