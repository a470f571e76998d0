// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/command_line.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>

#include "ipc/base/exit_code.hpp"

namespace handcast {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// What `handcast look` is asked for.
struct Look {
  std::string folder, shot, side = "left";
  std::vector<std::string> pictures, settings;
  double after_s = 2;
  int times = 0;
  bool quiet = false;
  std::string answer;  ///< the text of --help, or the refusal
  std::vector<std::string> given;
};

Look look(const std::vector<std::string>& arguments) {
  Look look;
  CommandLine line("handcast look", "Looks.", "See also: see.");
  line.add("DIR", look.folder, "The folder");
  line.add("[PICTURE...]", look.pictures, "Pictures");
  line.add("-s, --shot FILE", look.shot, "Writes a picture");
  line.add("--after N", look.after_s, "Seconds before it", {0.1, 3600});
  line.add("-j, --times N", look.times, "How often", {1, 9});
  line.add("--side left|right", look.side, "Which hand");
  line.add("--set path=value", look.settings, "A setting");
  line.add("--quiet", look.quiet, "Says nothing");
  line.add("--secret", look.quiet, "");
  const auto text = line.parse(arguments);
  look.answer = text ? *text : text.error().what;
  look.given = line.given();
  return look;
}

TEST(CommandLine, AnOptionTakesItsValueInEveryUsualWay) {
  const auto seen = look({"--shot=a=b.png", "out", "-j4", "--after", "0.5", "--set", "x=-1",
                          "--set=y=--z", "--quiet", "1.png", "--side", "right", "-"});
  EXPECT_EQ(seen.answer, "");
  EXPECT_EQ(seen.folder, "out");
  EXPECT_EQ(seen.shot, "a=b.png");
  EXPECT_EQ(seen.times, 4);
  EXPECT_EQ(seen.after_s, 0.5);
  EXPECT_EQ(seen.side, "right");
  EXPECT_TRUE(seen.quiet);
  EXPECT_THAT(seen.settings, ElementsAre("x=-1", "y=--z"));
  EXPECT_THAT(seen.pictures, ElementsAre("1.png", "-"));
  EXPECT_THAT(seen.given,
              ElementsAre("--shot", "--after", "--times", "--side", "--set", "--quiet"));
}

TEST(CommandLine, ATildeIsTheHomeFolderAlsoWhereAShellLeavesIt) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  if (home.empty()) GTEST_SKIP() << "HOME is not set";
  const auto seen = look({"~/out", "--shot=~/a.png", "~/1.png"});
  EXPECT_EQ(seen.folder, home + "/out");
  EXPECT_EQ(seen.shot, home + "/a.png");
  EXPECT_THAT(seen.pictures, ElementsAre(home + "/1.png"));
  EXPECT_EQ(look({"~no-such-user/out"}).folder, "~no-such-user/out");
}

TEST(CommandLine, ALongArgumentIsNotPrintedBack) {
  for (const auto* option : {"--side", "--after", "--"})
    EXPECT_LT(look({"out", option + std::string(option[2] ? "=" : "") + std::string(100'000, 'A')})
                  .answer.size(),
              400u);
}

TEST(CommandLine, TheLastValueCountsAndThereAreNoOptionsAfterTwoDashes) {
  EXPECT_EQ(look({"out", "--shot", "a.png", "-s", "b.png"}).shot, "b.png");
  const auto seen = look({"--", "--quiet", "--help"});
  EXPECT_EQ(seen.folder, "--quiet");
  EXPECT_THAT(seen.pictures, ElementsAre("--help"));
}

TEST(CommandLine, AMistypedOptionIsAnsweredWithTheNearestOne) {
  for (const auto* wrong : {"--shto", "--shto=a.png"})
    EXPECT_EQ(
        look({wrong, "a.png"}).answer,
        fmt::format("unknown option '{}' (did you mean '--shot'?); `handcast help look`", wrong));
  EXPECT_EQ(look({"--secrte"}).answer, "unknown option '--secrte'; `handcast help look`");
  EXPECT_EQ(look({"-x"}).answer, "unknown option '-x'; `handcast help look`");
}

TEST(CommandLine, AWrongValueIsNamedWithWhatIsAccepted) {
  const auto refused = [](std::vector<std::string> words) {
    words.insert(words.begin(), "out");
    const auto answer = look(words).answer;
    EXPECT_TRUE(answer.ends_with("; `handcast help look`")) << answer;
    return answer.substr(0, answer.rfind(';'));
  };
  for (const auto* wrong : {"soon", "nan", "inf", "-1", "0", "3601"})
    EXPECT_EQ(refused({"--after", wrong}),
              fmt::format("--after: '{}' is not a number in the range 0.1 to 3600", wrong));
  EXPECT_THAT(refused({"--after", "2s"}), HasSubstr("; write the number alone, without 's'"));
  EXPECT_THAT(refused({"--after=2,5"}), HasSubstr("; write 2.5, with a decimal point"));
  EXPECT_EQ(refused({"--times", "2.5"}),
            "--times: '2.5' is not a whole number in the range 1 to 9");
  EXPECT_EQ(refused({"--side", "both"}), "--side: 'both' is not one of left, right");
  EXPECT_EQ(refused({"--shot"}), "--shot needs a value");
  EXPECT_EQ(refused({"--shot="}), "--shot needs a value");
  EXPECT_EQ(refused({"--shot", ""}), "--shot needs a value");
  EXPECT_EQ(refused({"--quiet=yes"}), "--quiet takes no value");
}

TEST(CommandLine, TooFewTooManyAndEmptyArgumentsAreRefused) {
  EXPECT_EQ(look({}).answer, "DIR is missing; `handcast help look`");
  EXPECT_EQ(look({""}).answer, "an argument is empty; `handcast help look`");
  CommandLine daemon("handcast-eye", "Sees.");
  std::string file;
  daemon.add("[FILE]", file, "A file");
  EXPECT_EQ(daemon.parse({}).value(), "");
  EXPECT_EQ(daemon.parse({"a", "b"}).error().what,
            "'b' is one argument too many; `handcast-eye --help`");
}

TEST(CommandLine, HelpIsTheDeclarationsInWords) {
  const auto help = look({"-h"}).answer;
  EXPECT_EQ(help, look({"out", "--help"}).answer);
  EXPECT_THAT(help,
              AllOf(HasSubstr("usage: handcast look DIR [PICTURE...] [options]\n\nLooks.\n"),
                    HasSubstr("  -s, --shot FILE"), HasSubstr("\nSee also: see.\n"),
                    HasSubstr("Seconds before it (0.1 to 3600; default: 2)\n"),
                    HasSubstr("How often (1 to 9)\n"), HasSubstr("Which hand (default: left)\n"),
                    HasSubstr("A setting (may be repeated)\n"), Not(HasSubstr("--secret"))));
  EXPECT_THAT(look({"--version"}).answer, testing::StartsWith("handcast look "));
}

TEST(CommandLine, AProgramRunsOnlyIfNothingWasToBeAnswered) {
  EXPECT_EQ(answered("handcast look", std::string()), std::nullopt);
  EXPECT_EQ(answered("handcast look", std::string("usage\n")), kExitDone);
  EXPECT_EQ(answered("handcast look", fail(Errc::bad_config, "unknown option")), kExitUsage);
}

}  // namespace
}  // namespace handcast
