// SPDX-License-Identifier: Apache-2.0
#include "services/desk/knobs/knobs.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>

#include "tests/scratch.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk {
namespace {

using testing::HasSubstr;

constexpr const char* kMaster = "[[gesture]]\npath = \"light.master\"\nsource = \"right.pinch\"\n";

class Knobs : public testing::Test {
 protected:
  void write(const std::string& toml) {
    rig.desk.gestures = scratch.path() / "hands.toml";
    std::ofstream(rig.desk.gestures) << toml;
  }
  void open(const std::string& toml) {
    write(toml);
    auto opened = open_knobs(rig, panel);
    ASSERT_TRUE(opened) << opened.error().what;
    knobs = std::move(*opened);
  }
  void pass(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 60 + 0.5); ++i) {
      scene.now_ns += 1'000'000'000 / 60;
      knobs->turn(scene);
    }
  }
  Gesture& right() { return scene.gestures[1]; }
  double number(std::string_view path) const {
    return std::strtod(panel.value(path).c_str(), nullptr);
  }

  test::Scratch scratch;
  config::Rig rig;
  test::TablePanel panel;
  std::unique_ptr<Surface> knobs;
  Scene scene{.now_ns = 1'000'000'000};
};

TEST_F(Knobs, WithoutAFileThereAreNone) {
  EXPECT_EQ(*open_knobs(rig, panel), nullptr);
  rig.desk.gestures = "/no/such.toml";
  EXPECT_FALSE(open_knobs(rig, panel));
}

TEST_F(Knobs, AHandTurnsASettingAndItStaysWhenTheHandLeaves) {
  open(kMaster);
  pass(0.5);
  EXPECT_TRUE(panel.sets.empty()) << "nobody is there";
  right() = {.is_there = true, .pinch = 0.3f};
  pass(2);
  EXPECT_NEAR(number("light.master"), 0.3, 0.01);
  right().pinch = 1;
  pass(2);
  EXPECT_EQ(number("light.master"), 1) << "the end of the way is reached";
  right().pinch = 0.5f;
  pass(2);
  right() = {};
  pass(2);
  EXPECT_NEAR(number("light.master"), 0.5, 0.01);
  EXPECT_EQ(panel.source(), "gestures");
}

TEST_F(Knobs, TheValueGoesSmoothlyFromWhereItWas) {
  open(std::string(kMaster) + "smooth_s = 0.5\n");
  right() = {.is_there = true, .pinch = 0};
  double before = 1;
  for (int i = 0; i < 30; ++i) {
    pass(1. / 30);
    EXPECT_LE(before - number("light.master"), 0.1);
    before = number("light.master");
  }
  EXPECT_LT(before, 0.2);
}

TEST_F(Knobs, ItMayReturnToWhatItWasBefore) {
  open(std::string(kMaster) + "gone = \"return\"\n");
  right() = {.is_there = true, .pinch = 0.2f};
  pass(2);
  EXPECT_NEAR(number("light.master"), 0.2, 0.01);
  right() = {};
  pass(0.05);
  EXPECT_LT(number("light.master"), 0.9) << "it fades";
  pass(2);
  EXPECT_EQ(number("light.master"), 1);
  const auto sets = panel.sets.size();
  pass(2);
  EXPECT_EQ(panel.sets.size(), sets);
}

TEST_F(Knobs, WhatSomebodyElseTurnsIsTheirsUntilTheHandComesAgain) {
  open(std::string(kMaster) + "gone = \"return\"\n");
  right() = {.is_there = true, .pinch = 0.2f};
  pass(1);
  const std::vector<std::string> change{"light.master=0.7"};
  ASSERT_TRUE(panel.set(change, "page"));
  right().pinch = 0.4f;
  pass(1);
  EXPECT_EQ(panel.value("light.master"), "0.7");
  right() = {};
  pass(1);
  EXPECT_EQ(panel.value("light.master"), "0.7") << "it does not return either";
  right() = {.is_there = true, .pinch = 0.4f};
  pass(2);
  EXPECT_NEAR(number("light.master"), 0.4, 0.01);
}

TEST_F(Knobs, NoiseAroundAStepOrAStillHandChangesNothing) {
  open(std::string(kMaster) +
       "smooth_s = 0\n[[gesture]]\npath = \"light.freeze\"\nsource = \"right.fist\"\nsmooth_s = "
       "0\n");
  right() = {.is_there = true, .pinch = 0.3f, .fist = 0.5f};
  pass(1);
  const auto sets = panel.sets.size();
  for (int i = 0; i < 100; ++i) {
    right().pinch = 0.3f + 0.002f * static_cast<float>(i % 3 - 1);
    right().fist = 0.5f + 0.08f * static_cast<float>(i % 3 - 1);
    pass(1. / 30);
  }
  EXPECT_EQ(panel.sets.size(), sets);
  EXPECT_EQ(panel.value("light.freeze"), "false");
  right().fist = 0.7f;
  pass(0.1);
  EXPECT_EQ(panel.value("light.freeze"), "true");
  right().fist = 0.45f;
  pass(0.1);
  EXPECT_EQ(panel.value("light.freeze"), "true") << "not yet";
  right().fist = 0.3f;
  pass(0.1);
  EXPECT_EQ(panel.value("light.freeze"), "false");
}

TEST_F(Knobs, ChangesAreAtMostThirtyASecondAndAllOfThemOne) {
  open(std::string(kMaster) +
       "[[gesture]]\npath = \"projector.brightness\"\nsource = \"right.fist\"\n");
  right() = {.is_there = true};
  for (int i = 0; i < 240; ++i) {
    right().pinch = right().fist = static_cast<float>(i % 60) / 60;
    pass(1. / 60);
  }
  EXPECT_LE(panel.sets.size(), 121u);
  EXPECT_GT(panel.sets.size(), 60u);
  EXPECT_EQ(panel.sets.back().size(), 2u);
}

TEST_F(Knobs, WordsAreChosenAndNobodyIsASource) {
  open(R"([[gesture]]
path = "cascade.predict.method"
source = "right.spread"
[[gesture]]
path = "light.master"
source = "nobody"
max = 0.1
gone = "return"
)");
  const auto first = panel.value("cascade.predict.method");
  pass(2);
  EXPECT_EQ(panel.value("light.master"), "0.1");
  EXPECT_EQ(panel.value("cascade.predict.method"), first);
  right() = {.is_there = true, .spread = 1};
  pass(2);
  EXPECT_EQ(number("light.master"), 1);
  EXPECT_NE(panel.value("cascade.predict.method"), first);
}

TEST_F(Knobs, ARigThatDoesNotAnswerIsAskedAgain) {
  open(kMaster);
  panel.refusal = "the rig does not answer";
  right() = {.is_there = true, .pinch = 0};
  pass(2);
  EXPECT_EQ(number("light.master"), 1);
  panel.refusal.clear();
  pass(0.1);
  EXPECT_EQ(number("light.master"), 0);
}

TEST_F(Knobs, AFileThatIsWrittenAgainIsReadAgainUnlessItHasFaults) {
  open(kMaster);
  right() = {.is_there = true, .pinch = 0, .fist = 0.5f};
  pass(2);
  EXPECT_EQ(number("light.master"), 0);
  write("[[gesture]]\npath = \"light.nonsense\"\nsource = \"right.fist\"\n");
  pass(2);
  right().pinch = 1;
  pass(2);
  EXPECT_EQ(number("light.master"), 1) << "the old one stays";
  write("[[gesture]]\npath = \"projector.brightness\"\nsource = \"right.fist\"\n");
  pass(3);
  EXPECT_NEAR(number("projector.brightness"), 0.5, 0.01);
}

}  // namespace
}  // namespace handcast::desk
