// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/verb_options.hpp"

#include <gmock/gmock.h>

namespace handcast {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// What `handcast look` with these arguments is told: the text of --help, or the refusal.
std::string told(std::vector<std::string> words, bool is_needed = false) {
  CLI::App app("Looks.", "handcast look");
  std::string shot, folder, side;
  double after_s = 2;
  int times = 1;
  app.add_option("DIR", folder, "The folder")->required();
  app.add_option("--shot", shot, "Writes a picture");
  app.add_option("--after", after_s, "Seconds before it")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--times", times, "How often")->check(CLI::Range(1, 9))->required(is_needed);
  app.add_option("--side", side, "Which hand")->check(CLI::IsMember({"left", "right"}));
  words.insert(words.begin(), "look");
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  const auto text = parse_options(app, static_cast<int>(argv.size()), argv.data());
  return text ? *text : text.error().what;
}

TEST(VerbOptions, AMistypedOptionIsAnsweredWithTheNearestOne) {
  EXPECT_EQ(told({"out", "--shto", "a.png"}),
            "unknown option '--shto' (did you mean '--shot'?); `handcast help look`");
  EXPECT_EQ(told({"out", "--shto=a.png"}),
            "unknown option '--shto=a.png' (did you mean '--shot'?); `handcast help look`");
  EXPECT_EQ(told({"--shto"}),
            "unknown option '--shto' (did you mean '--shot'?); `handcast help look`");
  EXPECT_EQ(told({"out", "--", "more"}), "'more' is one argument too many; `handcast help look`");
  EXPECT_EQ(told({"out", "more"}), "'more' is one argument too many; `handcast help look`");
}

TEST(VerbOptions, AWrongValueIsNamedWithItsRange) {
  EXPECT_EQ(told({"out", "--after", "soon"}),
            "--after: 'soon' is not a number in the range 0.1 to 3600; `handcast help look`");
  EXPECT_EQ(told({"out", "--times", "2.5"}),
            "--times: '2.5' is not a whole number in the range 1 to 9; `handcast help look`");
  EXPECT_EQ(told({"out", "--shot"}), "--shot needs a value; `handcast help look`");
  EXPECT_EQ(told({}), "DIR is required; `handcast help look`");
}

TEST(VerbOptions, AProgramRunsOnlyIfNothingWasToBeAnswered) {
  const CLI::App app("Looks.", "handcast look");
  EXPECT_EQ(answered(app, std::string()), std::nullopt);
  EXPECT_EQ(answered(app, std::string("usage\n")), kExitDone);
  EXPECT_EQ(answered(app, fail(Errc::bad_config, "unknown option")), kExitUsage);
}

TEST(VerbOptions, HelpSaysRangesAndDefaultsInWords) {
  EXPECT_THAT(told({"--help"}),
              AllOf(HasSubstr("--after N"), HasSubstr("--side left|right"),
                    HasSubstr("--shot VALUE"), HasSubstr("--version "),
                    Not(HasSubstr("--version VALUE")), HasSubstr("(0.1 to 3600; default: 2)"),
                    Not(HasSubstr("FLOAT")), Not(HasSubstr("TEXT")), Not(HasSubstr("required"))));
  EXPECT_THAT(told({"--help"}, true), HasSubstr("(required; 1 to 9"));
}

}  // namespace
}  // namespace handcast
