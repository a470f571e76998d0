// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/cues.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/scratch.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kTurn_ns = 1'000'000'000 / 60;
constexpr double kNoon_s = 1'700'000'000 - 1'700'000'000 % 86400 + 12 * 3600;

class Cues : public testing::Test {
 protected:
  void SetUp() override {
    ::setenv("TZ", "UTC", 1);
    for (auto& hand : scene.gestures) hand.is_there = true;
    scene.now_ns = 1'000'000'000;
  }
  void open(const std::string& toml) {
    rig.desk.cues = scratch.path() / "cues.toml";
    std::ofstream(rig.desk.cues) << toml;
    reopen();
  }
  /// As after a restart of the process.
  void reopen() {
    cues.reset();
    auto opened = open_cues(rig, scratch.path() / "place", panel, [this] { return wall_s; });
    ASSERT_TRUE(opened) << opened.error().what;
    cues = std::move(*opened);
    cues->turn(scene);
  }
  /// So many seconds of turns.
  void pass(double seconds) {
    const int turns = static_cast<int>(seconds * 60 + 0.5);
    for (int i = 0; i < turns; ++i) turn();
  }
  void turn(const std::vector<std::string>& events = {}) {
    scene.now_ns += kTurn_ns;
    wall_s += 1.0 / 60;
    for (auto& hand : scene.gestures) hand.absent_s = hand.is_there ? 0 : hand.absent_s + 1.0 / 60;
    scene.events = events;
    cues->turn(scene);
  }
  int current() const { return cues->place()->current; }
  double number(std::string_view path) const {
    return std::strtod(panel.value(path).c_str(), nullptr);
  }
  void tell(bool are_there) {
    for (auto& hand : scene.gestures) hand.is_there = are_there;
  }

  test::Scratch scratch;
  config::Rig rig;
  test::TablePanel panel;
  std::unique_ptr<RunningCues> cues;
  Scene scene;
  double wall_s = kNoon_s;
};

TEST_F(Cues, WithoutAFileThereAreNone) {
  EXPECT_EQ(*open_cues(rig, "", panel), nullptr);
  rig.desk.cues = "/no/such.toml";
  EXPECT_FALSE(open_cues(rig, "", panel));
}

TEST_F(Cues, NumbersFadeAndTheRestSwitches) {
  open(R"([[cue]]
name = "Evening"
fade_s = 2
left = "tiger"
transition = "cut"
set.projector.brightness = 0.5
set.projector.fill.cells = 16
set.content.gravity = [0, 0, 1]
set.light.freeze = true
set.light.master = { to = 0, fade_s = 4 }
)");
  cues->go();
  turn();
  EXPECT_EQ(panel.value("light.freeze"), "true");
  EXPECT_EQ(panel.value("content.transition"), "\"cut\"");
  EXPECT_THAT(panel.shown, ElementsAre(std::pair<std::string, std::string>("left", "tiger")));
  EXPECT_EQ(panel.source(), "cue 1 'Evening'");
  EXPECT_EQ(number("projector.brightness"), 1);
  pass(1);
  EXPECT_NEAR(number("projector.brightness"), 0.75, 0.01);
  EXPECT_EQ(panel.value("projector.fill.cells"), "12");
  EXPECT_EQ(panel.value("content.gravity").substr(0, 7), "[0, 0.5")
      << panel.value("content.gravity");
  EXPECT_NEAR(number("light.master"), 0.75, 0.01);
  EXPECT_NEAR(cues->place()->faded, 0.25, 0.01);
  pass(1.1);
  EXPECT_EQ(panel.value("projector.brightness"), "0.5");
  EXPECT_EQ(panel.value("content.gravity"), "[0, 0, 1]");
  pass(2);
  EXPECT_EQ(panel.value("light.master"), "0");
  EXPECT_EQ(cues->place()->faded, 1);
  const auto sets = panel.sets.size();
  pass(1);
  EXPECT_EQ(panel.sets.size(), sets) << "nothing is set after the fades";
}

TEST_F(Cues, TheCurveIsThatOfTheFile) {
  open("[[cue]]\nfade_s = 4\ncurve = \"s-curve\"\nset.light.master = 0\n");
  cues->go();
  turn();
  pass(1);
  EXPECT_NEAR(number("light.master"), 1 - 0.15625, 0.01);
}

TEST_F(Cues, WhatAPersonTurnsDuringAFadeIsLeftToThem) {
  open("[[cue]]\nfade_s = 2\nset.light.master = 0\nset.projector.brightness = 0\n");
  cues->go();
  pass(1);
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=0.9"}, "page"));
  pass(2);
  EXPECT_EQ(panel.value("light.master"), "0.9");
  EXPECT_EQ(panel.value("projector.brightness"), "0");
}

TEST_F(Cues, GoBackAndJumpMoveInTheList) {
  open("[[cue]]\nname = \"a\"\n[[cue]]\nname = \"b\"\n[[cue]]\nname = \"c\"\n");
  EXPECT_THAT(cues->place()->names, ElementsAre("a", "b", "c"));
  EXPECT_EQ(current(), -1);
  cues->back();
  turn();
  EXPECT_EQ(current(), -1);
  for (const int expected : {0, 1, 2, 2}) {
    cues->go();
    turn();
    EXPECT_EQ(current(), expected);
  }
  EXPECT_EQ(cues->place()->next, 3);
  cues->back();
  turn();
  EXPECT_EQ(current(), 1);
  ASSERT_TRUE(cues->jump("a"));
  turn();
  EXPECT_EQ(current(), 0);
  ASSERT_TRUE(cues->jump("3"));
  turn();
  EXPECT_EQ(current(), 2);
  for (const auto* wrong : {"d", "0", "4", "-1", "2x", ""})
    EXPECT_FALSE(cues->jump(wrong)) << wrong;
  EXPECT_THAT(cues->jump("bb").error().what, HasSubstr("there is no cue 'bb'"));
}

TEST_F(Cues, AListMayLoop) {
  open("loop = true\n[[cue]]\n[[cue]]\n");
  for (const int expected : {0, 1, 0}) {
    cues->go();
    turn();
    EXPECT_EQ(current(), expected);
  }
}

TEST_F(Cues, HoldStopsFadesAndTriggers) {
  open("[[cue]]\nfade_s = 2\nset.light.master = 0\n[[cue]]\non = [\"after 3\", \"left.pinch\"]\n");
  cues->go();
  pass(1);
  cues->hold();
  turn();
  EXPECT_TRUE(cues->place()->is_held);
  const auto held = number("light.master");
  pass(5);
  turn({"left.pinch"});
  EXPECT_EQ(number("light.master"), held);
  EXPECT_EQ(current(), 0);
  cues->go();
  turn();
  EXPECT_FALSE(cues->place()->is_held);
  EXPECT_EQ(current(), 0) << "go only lets it go on";
  pass(1.1);
  EXPECT_EQ(panel.value("light.master"), "0");
  pass(1);
  EXPECT_EQ(current(), 1);
}

TEST_F(Cues, AKeyStartsItsCueEvenAgain) {
  open("[[cue]]\n[[cue]]\non = \"key g\"\nset.light.master = 0\n");
  cues->key("x");
  turn();
  EXPECT_EQ(current(), -1);
  cues->key("g");
  turn();
  EXPECT_EQ(current(), 1);
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=1"}, "page"));
  cues->key("g");
  turn();
  EXPECT_EQ(panel.value("light.master"), "0");
}

TEST_F(Cues, AnEventStartsTheNextCueThatWaitsForIt) {
  open(
      "[[cue]]\n[[cue]]\non = \"left.pinch\"\n[[cue]]\non = \"left.pinch\"\n"
      "[[cue]]\non = \"right.appears\"\n");
  std::vector<int> places;
  for (int i = 0; i < 3; ++i) {
    turn({"left.pinch"});
    places.push_back(current());
  }
  EXPECT_THAT(places, ElementsAre(1, 2, 1));
  turn({"right.appears"});
  EXPECT_EQ(current(), 3);
  ASSERT_TRUE(cues->jump("1"));
  turn();
  turn({"right.leaves", "left.appears"});
  EXPECT_EQ(current(), 0);
}

TEST_F(Cues, ACueStartsWhenNoHandWasThereForSomeTime) {
  open("[[cue]]\non = \"idle 3\"\n[[cue]]\non = \"left.appears\"\n");
  tell(false);
  pass(2.9);
  EXPECT_EQ(current(), -1);
  pass(0.2);
  EXPECT_EQ(current(), 0);
  tell(true);
  turn({"left.appears"});
  EXPECT_EQ(current(), 1);
  tell(false);
  pass(2.5);
  scene.gestures[1].is_there = true;
  turn();
  scene.gestures[1].is_there = false;
  pass(2);
  EXPECT_EQ(current(), 1) << "the other hand was there";
  pass(2);
  EXPECT_EQ(current(), 0);
  cues->go();
  pass(5);
  EXPECT_EQ(current(), 1) << "once, not as long as they are away";
}

TEST_F(Cues, ACueStartsAtItsTimeOfDay) {
  open("[[cue]]\non = \"at 12:00:02\"\n[[cue]]\non = \"at 00:00\"\n");
  pass(1.9);
  EXPECT_EQ(current(), -1);
  pass(0.2);
  EXPECT_EQ(current(), 0);
  wall_s = kNoon_s + 12 * 3600 - 1;
  turn();
  EXPECT_EQ(current(), 0);
  pass(2);
  EXPECT_EQ(current(), 1);
  wall_s = kNoon_s + 86400 + 1;
  turn();
  pass(2);
  EXPECT_EQ(current(), 0) << "every day";
}

TEST_F(Cues, AClockThatIsSetStartsNothing) {
  open("[[cue]]\non = \"at 12:00:02\"\n");
  wall_s += 3600;
  turn();
  EXPECT_EQ(current(), -1);
  wall_s -= 3600;
  turn();
  pass(3);
  EXPECT_EQ(current(), 0);
}

TEST_F(Cues, AnEventDoesNotStartTheCurrentCueAgain) {
  open("[[cue]]\non = \"left.pinch\"\nset.light.master = 0\n");
  turn({"left.pinch"});
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=1"}, "page"));
  turn({"left.pinch"});
  EXPECT_EQ(panel.value("light.master"), "1");
}

TEST_F(Cues, ACueFollowsTheOneBefore) {
  open("[[cue]]\n[[cue]]\non = \"after 2\"\n[[cue]]\non = \"after 1\"\n");
  pass(5);
  EXPECT_EQ(current(), -1) << "nothing is before the first";
  cues->go();
  pass(1.9);
  EXPECT_EQ(current(), 0);
  pass(0.2);
  EXPECT_EQ(current(), 1);
  pass(1.1);
  EXPECT_EQ(current(), 2);
}

TEST_F(Cues, ARestartGoesOnInItsPlace) {
  open(
      "[[cue]]\nname = \"a\"\nset.light.master = 0.5\n[[cue]]\nname = \"b\"\non = \"after 10\"\n"
      "[[cue]]\n");
  cues->go();
  pass(4);
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=0.7"}, "page"));
  reopen();
  EXPECT_EQ(current(), 0);
  EXPECT_EQ(cues->place()->next, 1);
  pass(1);
  EXPECT_EQ(panel.value("light.master"), "0.7") << "the cue was over, and is not started again";
  pass(5.2);
  EXPECT_EQ(current(), 1) << "ten seconds after the cue, not after the restart";
}

TEST_F(Cues, ARestartWithinAFadeEndsIt) {
  open("[[cue]]\nfade_s = 4\nset.light.master = 0\n");
  cues->go();
  pass(2);
  reopen();
  EXPECT_NEAR(number("light.master"), 0.5, 0.02) << "no jump";
  pass(4.1);
  EXPECT_EQ(panel.value("light.master"), "0");
}

TEST_F(Cues, AnotherListOrABrokenPlaceBeginsAtTheStart) {
  open("[[cue]]\nname = \"a\"\n");
  cues->go();
  turn();
  std::ofstream(rig.desk.cues) << "[[cue]]\nname = \"other\"\n";
  reopen();
  EXPECT_EQ(current(), -1);
  std::ofstream(scratch.path() / "place") << "list = 5";
  reopen();
  EXPECT_EQ(current(), -1);
}

TEST_F(Cues, ARigThatRefusesDoesNotStopTheList) {
  open("[[cue]]\nfade_s = 1\nset.light.master = 0\n");
  panel.refusal = "the rig is starting";
  cues->go();
  pass(0.5);
  panel.refusal.clear();
  pass(1);
  EXPECT_EQ(panel.value("light.master"), "0");
}

TEST_F(Cues, AListThatIsWrittenAgainIsReadAgainInItsPlace) {
  open("[[cue]]\nname = \"A\"\n[[cue]]\nname = \"B\"\nset.light.master = 0.5\n");
  const auto write = [this](const std::string& toml) {
    std::ofstream(rig.desk.cues) << toml;
    pass(2);
  };
  ASSERT_TRUE(cues->jump("B"));
  pass(1);
  write("[[cue]]\nname = \"B\"\nset.light.mastr = 0.2\n");
  EXPECT_THAT(cues->place()->names, ElementsAre("A", "B")) << "one with faults changes nothing";
  write(
      "[[cue]]\nname = \"New\"\n[[cue]]\nname = \"A\"\n[[cue]]\nname = \"B\"\n"
      "[[cue]]\nname = \"C\"\nset.light.master = 0.25\n");
  EXPECT_THAT(cues->place()->names, ElementsAre("New", "A", "B", "C"));
  EXPECT_EQ(current(), 2);
  EXPECT_EQ(panel.value("light.master"), "0.5") << "nothing starts by itself";
  cues->go();
  pass(0.1);
  EXPECT_EQ(panel.value("light.master"), "0.25");
  EXPECT_TRUE(cues->jump("New"));
}

TEST_F(Cues, ACueThatIsGoneFromTheListIsFollowedByTheOneInItsPlace) {
  open(
      "[[cue]]\nname = \"A\"\n[[cue]]\nname = \"B\"\nfade_s = 60\nset.light.master = 0\n"
      "[[cue]]\nname = \"C\"\n");
  ASSERT_TRUE(cues->jump("B"));
  pass(1);
  std::ofstream(rig.desk.cues) << "[[cue]]\nname = \"A\"\n[[cue]]\nname = \"C\"\n";
  pass(2);
  EXPECT_EQ(current(), -1);
  EXPECT_EQ(cues->place()->next, 1);
  const auto value = panel.value("light.master");
  pass(1);
  EXPECT_EQ(panel.value("light.master"), value) << "its fade has ended";
}

TEST_F(Cues, AFadeGoesOnInAListThatIsReadAgain) {
  open("[[cue]]\nname = \"A\"\nfade_s = 10\nset.light.master = 0\n");
  cues->go();
  pass(1);
  std::ofstream(rig.desk.cues) << "[[cue]]\nname = \"A\"\nfade_s = 2\nset.light.master = 0.4\n";
  pass(5);
  EXPECT_EQ(panel.value("light.master"), "0.4");
}

}  // namespace
}  // namespace handcast::desk
