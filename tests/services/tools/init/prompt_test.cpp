// SPDX-License-Identifier: Apache-2.0
#include "services/tools/init/prompt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace handcast::init {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A question that takes only "red" and "blue", and the answers that it got.
class Asked : public testing::Test {
 protected:
  Result<void> ask(const std::string& input) {
    std::istringstream in(input);
    Prompt prompt(in, out_);
    return settle(question_, flag_, &prompt);
  }
  Question question_{.flag = "--colour",
                     .text = "Which colour?",
                     .options = {{"red", "a warm one"}, {"blue", "a cold one"}},
                     .preset = "blue",
                     .take = [this](const std::string& answer) -> Result<void> {
                       if (answer != "red" && answer != "blue")
                         return fail(Errc::bad_config, "there is no '" + answer + "'");
                       taken_ = answer;
                       return {};
                     }};
  std::optional<std::string> flag_;
  std::string taken_;
  std::ostringstream out_;
};

TEST_F(Asked, ANumberAWordOrNothingIsAnAnswer) {
  EXPECT_TRUE(ask("1\n"));
  EXPECT_EQ(taken_, "red");
  EXPECT_TRUE(ask("\n"));
  EXPECT_EQ(taken_, "blue");
  EXPECT_TRUE(ask("  red \r\n"));
  EXPECT_EQ(taken_, "red");
  EXPECT_THAT(out_.str(),
              AllOf(HasSubstr("Which colour?\n  1  a warm one\n  2  a cold one\n[2] > ")));
}

TEST_F(Asked, NonsenseIsAskedAgainAndThenEndsWithAnError) {
  EXPECT_TRUE(ask("green\n3\n1\n"));
  EXPECT_EQ(taken_, "red");
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("there is no 'green'"), HasSubstr("there is no '3'")));
  taken_ = "";
  const auto refused = ask("green\n0\n-1\nred\n");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_config);
  EXPECT_EQ(refused.error().what,
            "no answer to 'Which colour?': there is no '-1'; --colour answers it, too");
  EXPECT_EQ(taken_, "");
}

TEST_F(Asked, TheEndOfTheInputIsNoAnswer) {
  for (const auto* input : {"", "green\n"}) {
    const auto refused = ask(input);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().what,
                HasSubstr("the input ended before the answer to 'Which colour?'; --colour"));
    EXPECT_EQ(taken_, "");
  }
}

TEST_F(Asked, AFlagIsHeardInsteadOfAsking) {
  flag_ = "red";
  EXPECT_TRUE(ask("blue\n"));
  EXPECT_EQ(taken_, "red");
  EXPECT_EQ(out_.str(), "");
  flag_ = "1";
  const auto refused = ask("");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what, "--colour: there is no '1'") << "nobody has seen the numbers";
}

TEST_F(Asked, WithoutAPersonOrAChoiceThePresetIsTaken) {
  EXPECT_TRUE(settle(question_, std::nullopt, nullptr));
  EXPECT_EQ(taken_, "blue");
  question_.options.resize(1);
  question_.preset = "red";
  EXPECT_TRUE(ask(""));
  EXPECT_EQ(taken_, "red");
  EXPECT_EQ(out_.str(), "");
}

TEST_F(Asked, AnswersAndTextsCannotMoveTheCursor) {
  question_.options[0].text = "\x1b[2J";
  EXPECT_TRUE(ask("\x1b[31m\n\n"));
  EXPECT_THAT(out_.str(), AllOf(Not(HasSubstr("\x1b")), HasSubstr("\\x1b[31m")));
}

}  // namespace
}  // namespace handcast::init
