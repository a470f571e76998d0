// SPDX-License-Identifier: Apache-2.0
#include "services/desk/cues/cue_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk::cues {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<CueList> read(const std::string& toml) {
  test::TablePanel panel;
  return parse_cues(toml, "/shows/evening.toml", panel.controls());
}
std::string faults_of(const std::string& toml) {
  const auto list = read(toml);
  return list ? "" : list.error().what;
}

TEST(CueList, ACueIsReadWithAllThatItHas) {
  const auto list = read(R"(
loop = true
[[cue]]
name = "Darkness"
on = ["key d", "at 20:15", "left.appears", "idle 30", "after 2.5"]
left = "tiger"
right = "film:a.mp4"
transition = "cut"
transition_s = 2
fade_s = 3
curve = "s-curve"
set.light.master = 0.2
set.light.freeze = true
set.projector.brightness = { to = 0.5, fade_s = 10, curve = "ease" }
[[cue]]
[cue.set.content]
gravity = [1, 0, 0.5]
[cue.set.cascade]
predict.method = "velocity"
[cue.set]
light.keep_out = ["0 0, 9 0, 9 9"]
)");
  ASSERT_TRUE(list) << list.error().what;
  EXPECT_TRUE(list->loops);
  ASSERT_EQ(list->cues.size(), 2u);
  const auto& first = list->cues[0];
  EXPECT_EQ(first.name, "Darkness");
  EXPECT_THAT(first.content, ElementsAre(testing::Pair("left", "tiger"),
                                         testing::Pair("right", HasSubstr("/shows/a.mp4"))));
  ASSERT_EQ(first.triggers.size(), 5u);
  EXPECT_EQ(first.triggers[0].name, "d");
  EXPECT_EQ(first.triggers[1].seconds, (20 * 60 + 15) * 60);
  EXPECT_EQ(first.triggers[2].name, "left.appears");
  EXPECT_EQ(first.triggers[3].seconds, 30);
  EXPECT_EQ(first.triggers[4].seconds, 2.5);
  ASSERT_EQ(first.targets.size(), 5u);
  EXPECT_EQ(first.targets[0].assignment, "content.transition=\"cut\"");
  EXPECT_EQ(first.targets[1].assignment, "content.transition_s=2");
  EXPECT_EQ(first.targets[2].fade_s, 3);
  EXPECT_EQ(first.targets[2].curve, Curve::s_curve);
  EXPECT_EQ(first.targets[3].assignment, "light.freeze=true");
  EXPECT_THAT(first.targets[4].numbers, ElementsAre(0.5));
  EXPECT_EQ(first.targets[4].fade_s, 10);
  EXPECT_EQ(first.targets[4].curve, Curve::ease);
  EXPECT_EQ(first.longest_fade_s(), 10);
  const auto& second = list->cues[1];
  EXPECT_EQ(second.name, "2");
  ASSERT_EQ(second.targets.size(), 3u);
  EXPECT_THAT(second.targets[0].numbers, ElementsAre(1, 0, 0.5));
  EXPECT_EQ(second.targets[1].assignment, "cascade.predict.method=\"velocity\"");
  EXPECT_EQ(second.targets[2].assignment, "light.keep_out=[\"0 0, 9 0, 9 9\"]");
}

TEST(CueList, AllFaultsAreNamedWithTheirLines) {
  const auto faults = faults_of(R"(looop = true
[[cue]]
name = "a"
fades = 3
fade_s = -1
curve = "wavy"
on = ["key", "at 25:00", "dawn"]
set.light.master = 2
set.light.mastr = 1
set.light.freeze = 0.5
set.projector.brightness = { fade_s = 2 }
set.content.gravity = [1, 2]
set.cascade.predict.method = "velocitty"
left = "film:\"a"
[[cue]]
name = "a"
set.light.keep_out = "no list"
set.projector.fill.cells = 2.5
)");
  for (const auto* part :
       {"/shows/evening.toml:1: there is no 'looop' (did you mean 'loop'?)",
        ":4: cue 1: there is no 'fades' (did you mean 'fade_s'?)", ":5: cue 1: fade_s must be",
        ":6: cue 1: curve must be one of: linear, ease, s-curve",
        ":7: cue 1: on: 'key' starts no cue", ":7: cue 1: on: 'at 25:00'", "on: 'dawn'",
        ":8: cue 1: light.master: 2 is outside 0..1",
        ":9: cue 1: there is no live setting 'light.mastr' (did you mean 'light.master'?)",
        ":10: cue 1: light.freeze must be true or false",
        ":11: cue 1: projector.brightness needs `to`",
        ":12: cue 1: content.gravity: 2 is outside -1..1",
        ":13: cue 1: cascade.predict.method: 'velocitty' is not one of",
        ":14: cue 1: left: ", ":15: cue 2: its name 'a' is that of another cue",
        ":17: cue 2: light.keep_out must be a list",
        ":18: cue 2: projector.fill.cells: 2.5 is no whole number"})
    EXPECT_THAT(faults, HasSubstr(part));
  EXPECT_EQ(std::ranges::count(faults, '\n'), 16) << faults;
}

TEST(CueList, OtherFilesAreRefused) {
  EXPECT_THAT(faults_of(""), HasSubstr("it has no cue"));
  EXPECT_THAT(faults_of("[cue]\nname = \"a\""), HasSubstr("two pairs of brackets"));
  EXPECT_THAT(faults_of("cue = [1]"), HasSubstr("begins with [[cue]]"));
  EXPECT_THAT(faults_of("[[cue]\n"), HasSubstr("/shows/evening.toml:1"));
  EXPECT_THAT(faults_of("[[cue]]\nset = 5"), HasSubstr("set must be settings"));
  EXPECT_THAT(faults_of("[[cue]]\nset.content.gravity = [1]"), HasSubstr("a list of 3 numbers"));
}

TEST(CueList, CurvesBeginAndEndWhereTheyShould) {
  for (const auto curve : {Curve::linear, Curve::ease, Curve::s_curve}) {
    EXPECT_EQ(progress(curve, 0), 0);
    EXPECT_EQ(progress(curve, 1), 1);
    EXPECT_EQ(progress(curve, 2), 1);
    for (double t = 0.01; t < 1; t += 0.01)
      EXPECT_GT(progress(curve, t), progress(curve, t - 0.01));
  }
  EXPECT_DOUBLE_EQ(progress(Curve::linear, 0.25), 0.25);
  EXPECT_GT(progress(Curve::ease, 0.25), 0.4);
  EXPECT_LT(progress(Curve::s_curve, 0.25), 0.2);
  EXPECT_DOUBLE_EQ(progress(Curve::s_curve, 0.5), 0.5);
}

}  // namespace
}  // namespace handcast::desk::cues
