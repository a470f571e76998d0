// SPDX-License-Identifier: Apache-2.0
#include "services/content/mixer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/content/fake_sources.hpp"

using namespace handcast;
using namespace handcast::content;
using test::Script;
using testing::HasSubstr;

namespace {

class MixerTest : public testing::Test {
 protected:
  Chain chain(std::string_view written) {
    return std::move(*Chain::open(*config::parse_content(written), test::small_opening(),
                                  test::opener(scripts_)));
  }
  void change(std::string_view written, std::string_view transition, double seconds = 1) {
    const auto changed = mixer_.change(chain(written), transition, seconds);
    ASSERT_TRUE(changed) << changed.error().what;
  }
  Result<bool> draw(double time_s) { return mixer_.draw(hand_, hand_, time_s); }
  std::uint32_t shown() { return mixer_.picture().at(1, 1); }

  std::map<std::string, Script> scripts_{{"a", {.colour = 0xff0000c8}},
                                         {"b", {.colour = 0xff000000}}};
  HandState hand_;
  Mixer mixer_{test::small_opening(), test::opener(scripts_)};
};

TEST_F(MixerTest, ShowsNothingBeforeTheFirstChange) {
  EXPECT_EQ(draw(0), false);
  EXPECT_EQ(shown(), 0u);
  EXPECT_EQ(mixer_.chain(), nullptr);
}

TEST_F(MixerTest, ACutShowsTheNewChainWithTheNextPicture) {
  change("fake:a", "cut");
  EXPECT_EQ(draw(5), true);
  EXPECT_EQ(shown(), 0xff0000c8u);
  EXPECT_FALSE(mixer_.is_changing());
}

TEST_F(MixerTest, AFadeGoesFromTheOneToTheOtherInTheLight) {
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fade", 2);
  EXPECT_EQ(shown(), 0xff0000c8u);
  EXPECT_EQ(draw(10), true);  // it begins here
  EXPECT_EQ(shown(), 0xff0000c8u);
  (void)draw(11);
  EXPECT_EQ(shown(), 0xff00008du);  // 200 / sqrt 2
  (void)draw(12);
  EXPECT_EQ(shown(), 0xff000000u);
  EXPECT_FALSE(mixer_.is_changing());
}

TEST_F(MixerTest, AChangeDuringAChangeGoesOnFromWhatIsShown) {
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fade", 2);
  (void)draw(10);
  (void)draw(11);
  const auto before = shown();
  scripts_["c"].colour = 0xff00ff00;
  change("fake:c", "fade", 2);
  EXPECT_EQ(shown(), before);
  (void)draw(11.1);
  EXPECT_EQ(shown(), before);
  (void)draw(12.1);
  EXPECT_EQ(shown(), 0xff00b464u);  // 255 and 141, by sqrt 2
  (void)draw(13.1);
  EXPECT_EQ(shown(), 0xff00ff00u);
}

TEST_F(MixerTest, ATransitionIsASourceOfTwoPictures) {
  scripts_["t"].inputs = 2;
  scripts_["t"].colour = 3;
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fake:t speed=2", 4);
  (void)draw(10);
  (void)draw(11);
  EXPECT_EQ(shown(), 0xff0000cbu);  // the first picture and 3
  EXPECT_EQ(scripts_["t"].moments[0].progress, 0);
  EXPECT_EQ(scripts_["t"].moments[1].progress, 0.25);
  EXPECT_EQ(scripts_["t"].values["speed"], "2");
  (void)draw(14);
  EXPECT_EQ(shown(), 0xff000000u);
}

TEST_F(MixerTest, WhatIsNoTransitionIsRefusedAndChangesNothing) {
  change("fake:a", "cut");
  (void)draw(0);
  const auto refused = mixer_.change(chain("fake:b"), "fake:x", 1);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("is no transition"));
  EXPECT_FALSE(mixer_.change(chain("fake:b"), "", 1));
  (void)draw(1);
  EXPECT_EQ(shown(), 0xff0000c8u);
}

TEST_F(MixerTest, ATransitionThatFailsBecomesAFade) {
  scripts_["t"] = {.inputs = 2, .fault = Error{Errc::bad_config, "no"}};
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fake:t", 2);
  EXPECT_EQ(draw(10).error().what, "transition: no");
  EXPECT_TRUE(draw(11));
  EXPECT_EQ(shown(), 0xff00008du);
}

TEST_F(MixerTest, ANewChainThatFailsLeavesTheOldOneRunning) {
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fade", 2);
  scripts_["b"].fault = Error{Errc::bad_config, "an endless loop"};
  const auto told = draw(10);
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().what, HasSubstr("an endless loop"));
  EXPECT_FALSE(mixer_.is_changing());
  scripts_["a"].colour = 0xff000001;
  EXPECT_EQ(draw(11), true);
  EXPECT_EQ(shown(), 0xff000001u);
}

TEST_F(MixerTest, ANewChainThatFailsInTheMiddleLeavesTheOldOneToo) {
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fade", 2);
  (void)draw(10);
  scripts_["b"].fault = Error{Errc::disconnected, "gone"};
  EXPECT_FALSE(draw(11));
  EXPECT_EQ(shown(), 0xff0000c8u);
}

TEST_F(MixerTest, EachChainHasATimeOfItsOwn) {
  change("fake:a", "cut");
  (void)draw(100);
  (void)draw(100.5);
  change("fake:b", "fade", 10);
  (void)draw(101);
  (void)draw(101.25);
  const auto& a = scripts_["a"].moments;
  EXPECT_EQ(a[0].time_s, 0);
  EXPECT_EQ(a[1].time_s, 0.5);
  EXPECT_EQ(a[1].step_s, 0.5);
  EXPECT_EQ(a[1].frame, 1u);
  EXPECT_EQ(a[3].time_s, 1.25);
  const auto& b = scripts_["b"].moments;
  EXPECT_EQ(b[0].time_s, 0);
  EXPECT_EQ(b[1].time_s, 0.25);
  EXPECT_GT(b[1].date.tm_year, 100);
  EXPECT_EQ(b[1].hand, &hand_);
}

TEST_F(MixerTest, ValuesAreSetInTheChainThatComes) {
  change("fake:a", "cut");
  (void)draw(0);
  change("fake:b", "fade", 10);
  ASSERT_TRUE(mixer_.chain()->set("speed", "4"));
  EXPECT_EQ(scripts_["b"].values["speed"], "4");
}

}  // namespace
