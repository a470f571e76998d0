// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "ipc/base/quote.hpp"

namespace handcast::content::shader {
namespace {

/// A function or an operator of an expression.
struct ExpressionCall {
  std::string_view name;
  int arguments;
  double (*value)(const double* arguments);
};

constexpr double kDegrees = 3.14159265358979323846 / 180;

constexpr std::array kExpressionCalls{
    ExpressionCall{"+", 2, [](const double* a) { return a[0] + a[1]; }},
    ExpressionCall{"-", 2, [](const double* a) { return a[0] - a[1]; }},
    ExpressionCall{"*", 2, [](const double* a) { return a[0] * a[1]; }},
    ExpressionCall{"/", 2, [](const double* a) { return a[0] / a[1]; }},
    ExpressionCall{"%", 2, [](const double* a) { return std::fmod(a[0], a[1]); }},
    ExpressionCall{"^", 2, [](const double* a) { return std::pow(a[0], a[1]); }},
    ExpressionCall{"<", 2, [](const double* a) { return a[0] < a[1] ? 1. : 0.; }},
    ExpressionCall{">", 2, [](const double* a) { return a[0] > a[1] ? 1. : 0.; }},
    ExpressionCall{"<=", 2, [](const double* a) { return a[0] <= a[1] ? 1. : 0.; }},
    ExpressionCall{">=", 2, [](const double* a) { return a[0] >= a[1] ? 1. : 0.; }},
    ExpressionCall{"==", 2, [](const double* a) { return a[0] == a[1] ? 1. : 0.; }},
    ExpressionCall{"!=", 2, [](const double* a) { return a[0] != a[1] ? 1. : 0.; }},
    ExpressionCall{"&&", 2, [](const double* a) { return a[0] != 0 && a[1] != 0 ? 1. : 0.; }},
    ExpressionCall{"||", 2, [](const double* a) { return a[0] != 0 || a[1] != 0 ? 1. : 0.; }},
    ExpressionCall{"negative", 1, [](const double* a) { return -a[0]; }},
    ExpressionCall{"!", 1, [](const double* a) { return a[0] == 0 ? 1. : 0.; }},
    ExpressionCall{"if", 3, [](const double* a) { return a[0] != 0 ? a[1] : a[2]; }},
    ExpressionCall{"floor", 1, [](const double* a) { return std::floor(a[0]); }},
    ExpressionCall{"ceil", 1, [](const double* a) { return std::ceil(a[0]); }},
    ExpressionCall{"round", 1, [](const double* a) { return std::round(a[0]); }},
    ExpressionCall{"trunc", 1, [](const double* a) { return std::trunc(a[0]); }},
    ExpressionCall{"int", 1, [](const double* a) { return std::trunc(a[0]); }},
    ExpressionCall{"float", 1, [](const double* a) { return a[0]; }},
    ExpressionCall{"fract", 1, [](const double* a) { return a[0] - std::floor(a[0]); }},
    ExpressionCall{"abs", 1, [](const double* a) { return std::abs(a[0]); }},
    ExpressionCall{"sign", 1, [](const double* a) { return double(a[0] > 0) - (a[0] < 0); }},
    ExpressionCall{"sqrt", 1, [](const double* a) { return std::sqrt(a[0]); }},
    ExpressionCall{"exp", 1, [](const double* a) { return std::exp(a[0]); }},
    ExpressionCall{"log", 1, [](const double* a) { return std::log(a[0]); }},
    ExpressionCall{"log2", 1, [](const double* a) { return std::log2(a[0]); }},
    ExpressionCall{"log10", 1, [](const double* a) { return std::log10(a[0]); }},
    ExpressionCall{"sin", 1, [](const double* a) { return std::sin(a[0]); }},
    ExpressionCall{"cos", 1, [](const double* a) { return std::cos(a[0]); }},
    ExpressionCall{"tan", 1, [](const double* a) { return std::tan(a[0]); }},
    ExpressionCall{"asin", 1, [](const double* a) { return std::asin(a[0]); }},
    ExpressionCall{"acos", 1, [](const double* a) { return std::acos(a[0]); }},
    ExpressionCall{"atan", 1, [](const double* a) { return std::atan(a[0]); }},
    ExpressionCall{"atan2", 2, [](const double* a) { return std::atan2(a[0], a[1]); }},
    ExpressionCall{"radians", 1, [](const double* a) { return a[0] * kDegrees; }},
    ExpressionCall{"degrees", 1, [](const double* a) { return a[0] / kDegrees; }},
    ExpressionCall{"pow", 2, [](const double* a) { return std::pow(a[0], a[1]); }},
    ExpressionCall{"min", 2, [](const double* a) { return std::min(a[0], a[1]); }},
    ExpressionCall{"max", 2, [](const double* a) { return std::max(a[0], a[1]); }},
    ExpressionCall{"step", 2, [](const double* a) { return a[1] < a[0] ? 0. : 1.; }},
    ExpressionCall{"mod", 2, [](const double* a) { return a[0] - a[1] * std::floor(a[0] / a[1]); }},
    ExpressionCall{"clamp", 3,
                   [](const double* a) { return std::min(std::max(a[0], a[1]), a[2]); }},
    ExpressionCall{"mix", 3, [](const double* a) { return a[0] + (a[1] - a[0]) * a[2]; }},
};

/// Operators that stand between two values, and how strongly they bind.
constexpr std::array<std::pair<std::string_view, int>, 14> kBinary{{{"||", 1},
                                                                    {"&&", 2},
                                                                    {"==", 3},
                                                                    {"!=", 3},
                                                                    {"<=", 4},
                                                                    {">=", 4},
                                                                    {"<", 4},
                                                                    {">", 4},
                                                                    {"+", 5},
                                                                    {"-", 5},
                                                                    {"*", 6},
                                                                    {"/", 6},
                                                                    {"%", 6},
                                                                    {"^", 8}}};
constexpr int kUnary = 7;

}  // namespace

/// Precedence climbing; the steps are appended in postfix order.
class ExpressionParser {
 public:
  explicit ExpressionParser(std::string_view text) : rest_(text) {}

  Result<Expression> parse() {
    Expression expression;
    steps_.clear();
    choice();
    skip();
    if (fault_.empty() && !rest_.empty()) fault_ = "ends with " + quote(rest_);
    if (!fault_.empty()) return fail(Errc::bad_config, fault_);
    expression.steps_ = std::move(steps_);
    return expression;
  }

 private:
  using Step = Expression::Step;

  void skip() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_[0])))
      rest_.remove_prefix(1);
  }
  bool take(std::string_view word) {
    skip();
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  void expect(std::string_view word) {
    if (fault_.empty() && !take(word))
      fault_ = rest_.empty() ? fmt::format("ends before a '{}'", word)
                             : fmt::format("has no '{}' before {}", word, quote(rest_));
  }
  void call(std::string_view name) {
    const auto found = std::ranges::find(kExpressionCalls, name, &ExpressionCall::name);
    steps_.push_back({Step::Kind::call, double(found - kExpressionCalls.begin()), {}});
  }

  void choice() {
    binary(1);
    if (!fault_.empty() || !take("?")) return;
    go_deeper();
    if (fault_.empty()) choice();
    expect(":");
    if (fault_.empty()) choice();
    --depth_;
    call("if");
  }

  void binary(int least) {
    value();
    while (fault_.empty()) {
      skip();
      const auto found = std::ranges::find_if(
          kBinary, [&](const auto& entry) { return rest_.starts_with(entry.first); });
      if (found == kBinary.end() || found->second < least) return;
      rest_.remove_prefix(found->first.size());
      binary(found->second + 1);
      call(found->first);
    }
  }

  void go_deeper() {
    constexpr int kDeepest = 100;
    if (++depth_ > kDeepest) fault_ = "is nested too deeply";
  }

  void value() {
    go_deeper();
    if (fault_.empty()) value_inside();
    --depth_;
  }

  void value_inside() {
    if (take("(")) {
      choice();
      return expect(")");
    }
    if (take("-")) return binary(kUnary), call("negative");
    if (take("!")) return binary(kUnary), call("!");
    if (take("+")) return binary(kUnary);
    if (take("$")) {
      const auto name = word();
      if (name.empty()) fault_ = "has a '$' without a name";
      steps_.push_back({Step::Kind::name, 0, std::string(name)});
      return;
    }
    if (const auto name = word(); !name.empty()) return function(name);
    number();
  }

  std::string_view word() {
    skip();
    std::size_t length = 0;
    while (length < rest_.size() &&
           (std::isalnum(static_cast<unsigned char>(rest_[length])) || rest_[length] == '_'))
      ++length;
    if (length == 0 || (std::isdigit(static_cast<unsigned char>(rest_[0])))) return {};
    const auto name = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return name;
  }

  void function(std::string_view name) {
    if (name == "PI" || name == "pi")
      return steps_.push_back({Step::Kind::number, 180 * kDegrees, {}});
    const auto found = std::ranges::find(kExpressionCalls, name, &ExpressionCall::name);
    if (found == kExpressionCalls.end() || name == "negative") {
      skip();
      if (rest_.starts_with('('))
        fault_ = fmt::format("has a function {} that there is not", quote(name));
      else
        steps_.push_back({Step::Kind::name, 0, std::string(name)});  // the "$" was forgotten
      return;
    }
    expect("(");
    for (int i = 0; i < found->arguments && fault_.empty(); ++i) {
      if (i > 0) expect(",");
      if (fault_.empty()) choice();
    }
    expect(")");
    call(name);
  }

  void number() {
    skip();
    double value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) {
      fault_ = rest_.empty() ? "ends before a number"
                             : fmt::format("has no number before {}", quote(rest_));
      return;
    }
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    if (rest_.starts_with('f') || rest_.starts_with('F')) rest_.remove_prefix(1);
    steps_.push_back({Step::Kind::number, value, {}});
  }

  std::string_view rest_;
  std::string fault_;
  std::vector<Step> steps_;
  int depth_ = 0;
};

Result<Expression> Expression::parse(std::string_view text) {
  return ExpressionParser(text).parse();
}

std::vector<std::string> Expression::names() const {
  std::vector<std::string> names;
  for (const Step& step : steps_)
    if (step.kind == Step::Kind::name) names.push_back(step.name);
  return names;
}

double Expression::value(const Lookup& lookup) const {
  std::vector<double> stack;
  for (const Step& step : steps_) {
    if (step.kind == Step::Kind::number) {
      stack.push_back(step.number);
    } else if (step.kind == Step::Kind::name) {
      stack.push_back(lookup(step.name).value_or(0));
    } else {
      const auto& call = kExpressionCalls[static_cast<std::size_t>(step.number)];
      const auto first = stack.end() - call.arguments;
      const double value = call.value(&*first);
      stack.erase(first, stack.end());
      stack.push_back(value);
    }
  }
  return stack.back();
}

}  // namespace handcast::content::shader
