// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/expression.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "services/content/shader/sloppy_json.hpp"

namespace handcast::content::shader {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

double value_of(std::string_view text) {
  const auto expression = Expression::parse(text);
  EXPECT_TRUE(expression) << text << ": " << expression.error().what;
  if (!expression) return NAN;
  return expression->value([](std::string_view name) -> std::optional<double> {
    if (name == "WIDTH") return 640;
    if (name == "HEIGHT") return 400;
    if (name == "blur") return 3;
    return std::nullopt;
  });
}

std::string expression_fault(std::string_view text) {
  const auto expression = Expression::parse(text);
  return expression ? "" : expression.error().what;
}

TEST(Expression, OperatorsBindAsInC) {
  EXPECT_EQ(value_of("1 + 2 * 3"), 7);
  EXPECT_EQ(value_of("(1 + 2) * 3"), 9);
  EXPECT_EQ(value_of("10 - 4 - 3"), 3);
  EXPECT_EQ(value_of("-2 + 5"), 3);
  EXPECT_EQ(value_of("7 % 4 / 2"), 1.5);
  EXPECT_EQ(value_of("1 < 2 && 3 <= 2 ? 10 : 20"), 20);
  EXPECT_EQ(value_of("0 ? 1 : 0 ? 2 : 3"), 3);
  EXPECT_EQ(value_of("2 ^ 3"), 8);
  EXPECT_EQ(value_of("-2 ^ 2"), -4);
}

TEST(Expression, NamesAndFunctionsOfSizes) {
  EXPECT_EQ(value_of("$WIDTH"), 640);
  EXPECT_EQ(value_of("$WIDTH/16.0"), 40);
  EXPECT_EQ(value_of("WIDTH / 2"), 320) << "the $ may be left out";
  EXPECT_EQ(value_of("floor($HEIGHT / max($blur, 1.0))"), 133);
  EXPECT_EQ(value_of("ceil(0.2) + round(0.6f) + min(1, 2)"), 3);
  EXPECT_EQ(value_of("mod(-1, 4)"), 3);
  EXPECT_EQ(value_of("  1e2  "), 100);
  EXPECT_EQ(value_of("$unknown + 1"), 1) << "the caller knows which names there are";
  EXPECT_THAT(Expression::parse("$a + b * $WIDTH")->names(), ElementsAre("a", "b", "WIDTH"));
}

TEST(Expression, WhatIsNoneIsNamed) {
  EXPECT_THAT(expression_fault(""), HasSubstr("ends before a number"));
  EXPECT_THAT(expression_fault("(1 + 2"), HasSubstr("ends before a ')'"));
  EXPECT_THAT(expression_fault("1 + * 2"), HasSubstr("no number before '* 2'"));
  EXPECT_THAT(expression_fault("sine(3)"), HasSubstr("a function 'sine' that there is not"));
  EXPECT_THAT(expression_fault("1 2"), HasSubstr("ends with '2'"));
  EXPECT_THAT(expression_fault("$"), HasSubstr("without a name"));
  EXPECT_THAT(expression_fault("min(1)"), HasSubstr("no ',' before ')'"));
  EXPECT_THAT(expression_fault(std::string(100'000, '(')), HasSubstr("nested too deeply"));
  EXPECT_THAT(expression_fault(std::string(100'000, '-')), HasSubstr("nested too deeply"));
  std::string choices;
  for (int i = 0; i < 100'000; ++i) choices += "1?1:";
  EXPECT_THAT(expression_fault(choices + "1"), HasSubstr("nested too deeply"));
}

TEST(SloppyJson, WhatPeopleWriteBecomesJson) {
  EXPECT_EQ(strict_json(R"({"a": [1, 2,], })"), R"({"a": [1, 2 ]  })");
  EXPECT_EQ(strict_json("\"\xc3\xab \xff\""), "\"\xc3\xab ?\"") << "bytes of Latin-1";
  EXPECT_EQ(strict_json(R"({"a": .5, "b": 1., "c": -.25, "d": +3, "e": 007})"),
            R"({"a": 0.5, "b": 1.0, "c": -0.25, "d": 3, "e": 7})");
  EXPECT_EQ(strict_json("{\"a\": \"x\ty\"}"), "{\"a\": \"x\\u0009y\"}");
  EXPECT_EQ(strict_json(R"({"a": "C:\path"})"), R"({"a": "C:\\path"})");
  EXPECT_EQ(strict_json("1 // two\n3"), "1       \n3");
  EXPECT_EQ(strict_json("1 /* 2\n */ 3"), "1     \n    3");
  EXPECT_EQ(strict_json(R"("no // comment, ]")"), R"("no // comment, ]")");
  EXPECT_EQ(strict_json("1.0f, 1e-3"), "1.0, 1e-3");
}

TEST(SloppyJson, NothingEndsBehindTheText) {
  for (const auto* text : {"\"", "\"\\", "/", "/*", "//", "-", "+", ".", "1e", "1.", "\"\\u"})
    EXPECT_LT(strict_json(text).size(), 12u) << text;
}

}  // namespace
}  // namespace handcast::content::shader
