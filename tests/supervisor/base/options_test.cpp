// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/options.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const OptionTable kTable{.with_value = {"--set"}, .flags = {"--json"}, .words = {"RIG.toml"}};

std::string refusal(const std::vector<std::string>& arguments) {
  const auto options = sort_options(arguments, kTable);
  return options ? "sorted" : options.error().what;
}

TEST(Options, AreSortedIntoWordsValuesAndFlags) {
  const auto options = sort_options({"--set", "a=1", "rig.toml", "--set", "b=2", "--json"}, kTable);
  ASSERT_TRUE(options);
  EXPECT_THAT(options->words, ElementsAre("rig.toml"));
  EXPECT_THAT(options->all("--set"), ElementsAre("a=1", "b=2"));
  EXPECT_TRUE(options->has("--json"));
}

TEST(Options, ThatAreUnknownEmptyOrTooFewOrManyAreSaid) {
  EXPECT_EQ(refusal({"--sett", "a"}), "unknown option '--sett' (did you mean '--set'?)");
  EXPECT_EQ(refusal({"--quite-another"}), "unknown option '--quite-another'");
  EXPECT_THAT(refusal({"rig.toml", "--set"}), HasSubstr("--set needs a value"));
  EXPECT_THAT(refusal({"rig.toml", "--set", ""}), HasSubstr("--set needs a value"));
  EXPECT_THAT(refusal({""}), HasSubstr("an argument is empty"));
  EXPECT_EQ(refusal({}), "RIG.toml is missing");
  EXPECT_THAT(refusal({"a", "b"}), HasSubstr("'b' is one argument too many"));
}

}  // namespace
}  // namespace handcast::supervisor
