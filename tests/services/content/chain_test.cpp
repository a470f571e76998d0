// SPDX-License-Identifier: Apache-2.0
#include "services/content/chain.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/content/fake_sources.hpp"

using namespace handcast;
using namespace handcast::content;
using test::Script;
using testing::HasSubstr;

namespace {

class ChainTest : public testing::Test {
 protected:
  Result<Chain> open(std::string_view written) {
    return Chain::open(*config::parse_content(written), test::small_opening(),
                       test::opener(scripts_));
  }
  Result<bool> draw(Chain& chain, double time_s = 0) {
    Moment moment;
    moment.time_s = time_s;
    moment.hand = moment.other = &hand_;
    return chain.draw(moment, out_);
  }

  std::map<std::string, Script> scripts_;
  HandState hand_;
  renderer::Texture out_{5, 3};
};

TEST_F(ChainTest, OneSourceDrawsItself) {
  scripts_["a"].colour = 0xff102030;
  auto chain = open("fake:a");
  ASSERT_TRUE(chain);
  EXPECT_EQ(draw(*chain), true);
  EXPECT_EQ(out_.at(4, 2), 0xff102030);
}

TEST_F(ChainTest, ALaterSourceIsLaidOverAndAFilterIsGivenWhatIsBelow) {
  scripts_["a"].colour = 0xff102030;
  scripts_["b"].colour = 0x80804020;
  scripts_["f"].inputs = 1;
  scripts_["f"].colour = 1;
  auto chain = open("fake:a | fake:b blend=add | fake:f");
  ASSERT_TRUE(chain);
  EXPECT_EQ(draw(*chain), true);
  EXPECT_EQ(out_.at(0, 0), 0xff906051);
}

TEST_F(ChainTest, OpacityOfAFilterMixesItWithItsInput) {
  scripts_["a"].colour = 0xff000000;
  scripts_["f"].inputs = 1;
  scripts_["f"].colour = 100;
  auto chain = open("fake:a | fake:f opacity=0.4");
  ASSERT_TRUE(chain);
  (void)draw(*chain);
  EXPECT_EQ(out_.at(0, 0), 0xff000028);
  ASSERT_TRUE(chain->set("2.opacity", "1"));
  EXPECT_EQ(draw(*chain, 1), true);
  EXPECT_EQ(out_.at(0, 0), 0xff000064);
  ASSERT_TRUE(chain->set("2.opacity", "0"));
  EXPECT_EQ(draw(*chain, 2), true);
  EXPECT_EQ(out_.at(0, 0), 0xff000000);
}

TEST_F(ChainTest, AFilterThatComesFirstFiltersNothing) {
  scripts_["f"].inputs = 1;
  scripts_["f"].colour = 7;
  auto chain = open("fake:f");
  ASSERT_TRUE(chain);
  (void)draw(*chain);
  EXPECT_EQ(out_.at(0, 0), 7u);
}

TEST_F(ChainTest, AStillPictureIsToldOnceAndEachChangeOfOpacityToo) {
  scripts_["a"] = {.colour = 0xff000040, .is_still = true};
  scripts_["b"] = {.colour = 0xff008000, .is_still = true};
  auto chain = open("fake:a | fake:b");
  ASSERT_TRUE(chain);
  EXPECT_EQ(draw(*chain), true);
  EXPECT_EQ(draw(*chain, 1), false);
  ASSERT_TRUE(chain->set("2.opacity", "0"));
  EXPECT_EQ(draw(*chain, 2), true);
  EXPECT_EQ(out_.at(0, 0), 0xff000040);
  EXPECT_EQ(draw(*chain, 3), false);
  scripts_["a"].colour = 0xff000041;
  EXPECT_EQ(draw(*chain, 4), true);
  EXPECT_EQ(out_.at(0, 0), 0xff000041);
}

TEST_F(ChainTest, AStillLowestPictureSurvivesAChangeOfItsOpacity) {
  scripts_["a"] = {.colour = 0xff0000ff, .is_still = true};
  auto chain = open("fake:a");
  ASSERT_TRUE(chain);
  (void)draw(*chain);
  ASSERT_TRUE(chain->set("opacity", "0.2"));
  EXPECT_EQ(draw(*chain, 1), true);
  EXPECT_EQ(out_.at(0, 0), 0x33000033u);
  ASSERT_TRUE(chain->set("opacity", "1"));
  EXPECT_EQ(draw(*chain, 2), true);
  EXPECT_EQ(out_.at(0, 0), 0xff0000ffu);
}

TEST_F(ChainTest, AnErrorInOneElementRefusesTheWholeAndNamesIt) {
  scripts_["b"].closed = Error{Errc::bad_config, "it is broken"};
  const auto chain = open("fake:a | fake:b");
  ASSERT_FALSE(chain);
  EXPECT_EQ(chain.error().what, "fake:b: it is broken");
  EXPECT_EQ(chain.error().code, Errc::bad_config);
}

TEST_F(ChainTest, ATransitionIsRefused) {
  scripts_["t"].inputs = 2;
  const auto chain = open("fake:t");
  ASSERT_FALSE(chain);
  EXPECT_THAT(chain.error().what, HasSubstr("transition"));
}

TEST_F(ChainTest, BadBlendAndOpacityAreRefusedWithWhatIsAllowed) {
  EXPECT_THAT(open("fake:a blend=burn").error().what, HasSubstr("lighten"));
  EXPECT_THAT(open("fake:a opacity=1.5").error().what, HasSubstr("0 to 1"));
  EXPECT_THAT(open("fake:a opacity=nan").error().what, HasSubstr("opacity"));
  scripts_["f"].inputs = 1;
  EXPECT_THAT(open("fake:a | fake:f blend=add").error().what, HasSubstr("no blend"));
}

TEST_F(ChainTest, ADamagedPictureKeepsTheLastOneAndIsToldOnce) {
  scripts_["a"].colour = 0xff000005;
  auto chain = open("fake:a | fake:b opacity=0");
  (void)draw(*chain);
  scripts_["a"].fault = Error{Errc::bad_data, "frame 3 is damaged"};
  const auto told = draw(*chain, 1);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().what, "fake:a: frame 3 is damaged");
  EXPECT_EQ(out_.at(0, 0), 0xff000005u);
  EXPECT_TRUE(draw(*chain, 2));
  const int drawn = scripts_["a"].drawn;
  scripts_["a"].fault.reset();
  EXPECT_EQ(draw(*chain, 3), true);
  EXPECT_EQ(scripts_["a"].drawn, drawn + 1);
}

TEST_F(ChainTest, AChangeThatAnErrorHidIsToldByTheNextCall) {
  scripts_["a"] = {.colour = 0xff000005, .is_still = true};
  auto chain = open("fake:a | fake:b opacity=0");
  scripts_["b"].fault = Error{Errc::bad_config, "no"};
  EXPECT_FALSE(draw(*chain));
  EXPECT_EQ(out_.at(0, 0), 0xff000005u);
  EXPECT_EQ(draw(*chain, 1), true);
  EXPECT_EQ(draw(*chain, 2), false);
}

TEST_F(ChainTest, AnUnavailableElementIsReopenedEveryTwoSeconds) {
  auto chain = open("fake:a speed=3");
  ASSERT_TRUE(chain);
  (void)draw(*chain);
  ASSERT_TRUE(chain->set("speed", "5"));
  scripts_["a"].fault = Error{Errc::disconnected, "the camera is gone"};
  EXPECT_FALSE(draw(*chain, 10));
  EXPECT_TRUE(draw(*chain, 11.9));
  EXPECT_EQ(scripts_["a"].opened, 1);
  scripts_["a"].closed = Error{Errc::unavailable, "the camera is gone"};
  EXPECT_EQ(draw(*chain, 12.5), false);  // said before
  EXPECT_EQ(scripts_["a"].opened, 2);
  scripts_["a"].closed.reset();
  scripts_["a"].fault.reset();
  scripts_["a"].values.clear();
  EXPECT_EQ(draw(*chain, 13), false);
  EXPECT_EQ(draw(*chain, 15), true);
  EXPECT_EQ(scripts_["a"].opened, 3);
  EXPECT_EQ(scripts_["a"].values["speed"], "5");  // what was set is set again
  EXPECT_EQ(scripts_["a"].moments.back().time_s, 0);
  EXPECT_EQ(scripts_["a"].moments.back().frame, 0u);
}

TEST_F(ChainTest, AnElementWithBadConfigurationRestsUntilItsFileChangesOrAValueIsSet) {
  auto chain = open("fake:a");
  scripts_["a"].fault = Error{Errc::bad_config, "line 3: no such function"};
  EXPECT_FALSE(draw(*chain));
  EXPECT_TRUE(draw(*chain, 5));
  EXPECT_EQ(scripts_["a"].drawn, 1);
  EXPECT_EQ(scripts_["a"].opened, 1);
  scripts_["a"].fault.reset();
  scripts_["a"].is_stale = true;
  EXPECT_EQ(draw(*chain, 6), true);
  EXPECT_EQ(scripts_["a"].opened, 2);
}

TEST_F(ChainTest, AFileThatCannotBeReadAgainLeavesTheOldPictureRunning) {
  auto chain = open("fake:a");
  (void)draw(*chain);
  scripts_["a"].is_stale = true;
  scripts_["a"].closed = Error{Errc::bad_config, "it is truncated"};
  const auto told = draw(*chain, 1);
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().what, HasSubstr("truncated"));
  EXPECT_EQ(scripts_["a"].drawn, 2);
  EXPECT_EQ(draw(*chain, 1.6), true);
  EXPECT_EQ(scripts_["a"].opened, 2);  // not again within 2 s
}

TEST_F(ChainTest, AFilterThatNeverDrewLetsThroughWhatIsBelow) {
  scripts_["a"].colour = 0xff0000aa;
  scripts_["f"].inputs = 1;
  scripts_["f"].fault = Error{Errc::bad_config, "no"};
  auto chain = open("fake:a | fake:f");
  (void)draw(*chain);
  EXPECT_EQ(out_.at(2, 1), 0xff0000aau);
}

TEST_F(ChainTest, ASourceOfNothingButErrorsNeverEndsTheOthers) {
  auto chain = open("fake:a | fake:b");
  for (int i = 0; i < 100; ++i) {
    const auto code = static_cast<Errc>(i % 5);
    scripts_["b"].fault = Error{code, fmt::format("error {}", i)};
    scripts_["b"].closed = scripts_["b"].fault;
    scripts_["a"].colour = 0xff000000u + static_cast<std::uint32_t>(i);
    (void)draw(*chain, i);
    EXPECT_EQ(out_.at(0, 0), scripts_["a"].colour);
  }
}

TEST_F(ChainTest, ValuesAreSetByNumberOrInTheLowestElementThatHasThem) {
  auto chain = open("fake:a | fake:b");
  EXPECT_TRUE(chain->set("2.speed", "7"));
  EXPECT_EQ(scripts_["b"].values["speed"], "7");
  EXPECT_TRUE(chain->set("speed", "8"));
  EXPECT_EQ(scripts_["a"].values["speed"], "8");
  EXPECT_THAT(chain->set("size", "8").error().what, HasSubstr("2.speed"));
  EXPECT_THAT(chain->set("3.speed", "8").error().what, HasSubstr("2 elements"));
  EXPECT_FALSE(chain->set("2.size", "8"));
  EXPECT_FALSE(chain->set("0.speed", "8"));
  EXPECT_FALSE(chain->set("", "8"));
}

TEST_F(ChainTest, ParametersAreNumberedIfThereAreSeveralElements) {
  const auto one = open("fake:a")->parameters();
  std::vector<std::string> names;
  for (const auto& parameter : one) names.push_back(parameter.name);
  EXPECT_THAT(names, testing::ElementsAre("speed", "hit", "blend", "opacity"));
  EXPECT_EQ(open("fake:a | fake:b")->parameters()[4].name, "2.speed");
}

TEST_F(ChainTest, AnEventIsNotRepeatedWhenTheSourceIsReopened) {
  auto chain = open("fake:a");
  (void)draw(*chain);
  ASSERT_TRUE(chain->set("hit", "1"));
  scripts_["a"].values.clear();
  scripts_["a"].is_stale = true;
  (void)draw(*chain, 1);
  EXPECT_EQ(scripts_["a"].opened, 2);
  EXPECT_EQ(scripts_["a"].values.count("hit"), 0u);
}

}  // namespace
