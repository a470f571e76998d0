// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/options.hpp"

#include <gmock/gmock.h>

namespace handcast::simulate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<Options> parse_words(std::vector<const char*> words) {
  words.insert(words.begin(), "handcast-simulate");
  return parse(static_cast<int>(words.size()), words.data());
}

TEST(SimulateOptions, ShortcutsAreSettings) {
  const auto options = parse_words({"rig.toml", "--motion", "builtin:wave", "--speed", "2",
                                    "--seed", "7", "--set", "cascade.fill.method=none"});
  ASSERT_TRUE(options);
  EXPECT_THAT(options->settings, ElementsAre("twin.motion=builtin:wave", "twin.speed=2",
                                             "twin.seed=7", "cascade.fill.method=none"));
}

TEST(SimulateOptions, AnUnknownOptionIsNamed) {
  const auto options = parse_words({"rig.toml", "--fast"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("--fast"));
}

TEST(SimulateOptions, ANumberOutOfRangeSaysTheRange) {
  const auto options = parse_words({"rig.toml", "--seconds", "soon"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what,
              HasSubstr("--seconds: 'soon' is not a number in the range 0.01 to 86400"));
}

TEST(SimulateOptions, ACountIsAWholeNumber) {
  const auto options = parse_words({"rig.toml", "--draw-every", "0.4"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("--draw-every: '0.4' is not a whole number"));
}

TEST(SimulateOptions, WithoutARigItSaysWhereTheUsageIs) {
  const auto options = parse_words({});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("RIG.toml is missing; `handcast help simulate`"));
}

TEST(SimulateOptions, TheHelpNamesEveryLandmarkModel) {
  EXPECT_THAT(parse_words({"-h"})->text, HasSubstr("--set landmarks.backend=handcast|mediapipe\n"));
}

TEST(SimulateOptions, AMissingValueIsNoted) { EXPECT_FALSE(parse_words({"rig.toml", "--json"})); }

}  // namespace
}  // namespace handcast::simulate
