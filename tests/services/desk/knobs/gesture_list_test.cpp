// SPDX-License-Identifier: Apache-2.0
#include "services/desk/knobs/gesture_list.hpp"

#include <gmock/gmock.h>

#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk::knobs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class GestureList : public testing::Test {
 protected:
  std::string faults(const std::string& toml) {
    const auto read = parse_gestures(toml, "hands.toml", panel.controls());
    return read ? "none" : read.error().what;
  }
  test::TablePanel panel;
};

TEST_F(GestureList, WhatIsLeftOutIsTheWholeRange) {
  const auto read = parse_gestures(R"([[gesture]]
path = "light.master"
source = "right.pinch"
[[gesture]]
path = "projector.brightness"
source = "either.palm_up"
from = 0.5
min = 0.2
max = 0.8
curve = "s-curve"
smooth_s = 0.5
gone = "return"
)",
                                   "hands.toml", panel.controls());
  ASSERT_TRUE(read) << read.error().what;
  const auto &first = read->at(0), &second = read->at(1);
  EXPECT_EQ(panel.controls()[first.control].path, "light.master");
  EXPECT_EQ(first.source.whose, Source::Whose::right);
  EXPECT_EQ(first.source.amount, Amount::pinch);
  EXPECT_EQ(first.from, 0);
  EXPECT_EQ(first.to, 1);
  EXPECT_EQ(first.first, 0);
  EXPECT_EQ(first.last, 1);
  EXPECT_FALSE(first.returns);
  EXPECT_EQ(second.from, 0.5);
  EXPECT_EQ(second.first, 0.2);
  EXPECT_EQ(second.last, 0.8);
  EXPECT_EQ(second.curve, cues::Curve::s_curve);
  EXPECT_TRUE(second.returns);
}

TEST_F(GestureList, AllFaultsAreNamedWithTheirLines) {
  EXPECT_THAT(faults(R"([[gesture]]
path = "light.mastr"
source = "right.pinch"
[[gesture]]
path = "light.master"
source = "middle.pinch"
max = 2
curve = "wild"
colour = 1
[[gesture]]
path = "content.left"
source = "left.fist"
gone = "sleep"
)"),
              AllOf(HasSubstr("hands.toml:2: there is no live setting 'light.mastr' (did you mean"),
                    HasSubstr("hands.toml:6: 'middle.pinch' is nothing that a hand does"),
                    HasSubstr("hands.toml:7: max must be a number, 0..1"),
                    HasSubstr("hands.toml:8: curve must be one of: linear"),
                    HasSubstr("hands.toml:9: there is no 'colour'"),
                    HasSubstr("hands.toml:11: content.left is not one number"),
                    HasSubstr("hands.toml:13: gone must be one of: hold, return")));
}

TEST_F(GestureList, OneSettingHasOneHand) {
  EXPECT_THAT(faults(R"([[gesture]]
path = "light.master"
source = "left.fist"
[[gesture]]
path = "light.master"
source = "right.fist"
)"),
              HasSubstr("hands.toml:5: light.master is turned by another gesture already"));
  EXPECT_THAT(faults("[[gesture]]\nsource = \"left.fist\"\n"), HasSubstr("a gesture needs path"));
  EXPECT_THAT(faults("[gesture]\npath = \"light.master\"\n"), HasSubstr("begins with [[gesture]]"));
  EXPECT_THAT(faults("gestures = 1\n"), HasSubstr("there is no 'gestures'"));
  EXPECT_EQ(faults(""), "none");
}

TEST_F(GestureList, ASourceIsTheHandThatItNames) {
  Scene scene;
  scene.gestures[0] = {.is_there = true, .fist = 0.25f};
  const Source left{Source::Whose::left, Amount::open}, right{Source::Whose::right, Amount::open},
      either{Source::Whose::either, Amount::fist}, nobody{Source::Whose::nobody, Amount::there};
  EXPECT_EQ(left.at(scene), 0.75);
  EXPECT_EQ(right.at(scene), std::nullopt);
  EXPECT_EQ(either.at(scene), 0.25);
  EXPECT_EQ(nobody.at(scene), std::nullopt);
  scene.gestures[1] = {.is_there = true, .fist = 0.5f};
  EXPECT_EQ(either.at(scene), 0.5);
  scene.gestures = {};
  EXPECT_EQ(nobody.at(scene), 1);
}

}  // namespace
}  // namespace handcast::desk::knobs
