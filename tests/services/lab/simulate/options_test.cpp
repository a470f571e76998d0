// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/options.hpp"

#include <gmock/gmock.h>

namespace handcast::simulate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<Options> parse(std::vector<const char*> words) {
  words.insert(words.begin(), "handcast-simulate");
  return parse_options(static_cast<int>(words.size()), words.data());
}

TEST(SimulateOptions, ShortcutsAreSettings) {
  const auto options = parse({"rig.toml", "--motion", "builtin:wave", "--speed", "2", "--seed", "7",
                              "--set", "cascade.fill.method=none"});
  ASSERT_TRUE(options);
  EXPECT_THAT(options->settings, ElementsAre("twin.motion=builtin:wave", "twin.speed=2",
                                             "twin.seed=7", "cascade.fill.method=none"));
}

TEST(SimulateOptions, AnUnknownOptionIsNamed) {
  const auto options = parse({"rig.toml", "--fast"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("--fast"));
}

TEST(SimulateOptions, ANumberOutOfRangeSaysTheRange) {
  const auto options = parse({"rig.toml", "--seconds", "soon"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("'soon' is not a number from"));
}

TEST(SimulateOptions, ACountIsAWholeNumber) {
  const auto options = parse({"rig.toml", "--draw-every", "0.4"});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("--draw-every: '0.4' is not a whole number"));
}

TEST(SimulateOptions, WithoutARigItSaysWhatToType) {
  const auto options = parse({});
  ASSERT_FALSE(options);
  EXPECT_THAT(options.error().what, HasSubstr("config/rigs/twin.toml"));
}

TEST(SimulateOptions, TheHelpNamesEveryLandmarkModel) {
  EXPECT_THAT(help(), HasSubstr("--set landmarks.backend=handcast|mediapipe\n"));
}

TEST(SimulateOptions, AMissingValueIsNoted) { EXPECT_FALSE(parse({"rig.toml", "--json"})); }

}  // namespace
}  // namespace handcast::simulate
