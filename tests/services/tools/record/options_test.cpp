// SPDX-License-Identifier: Apache-2.0
#include "services/tools/record/options.hpp"

#include <gmock/gmock.h>

namespace handcast::record {
namespace {

using Names = std::vector<std::string>;

const Names kThere{"camera.frames", "pose.hands", "marks.camera", "marks.pose"};

Result<Parsed> parsed(std::vector<std::string> words) {
  words.insert(words.begin(), "record");
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  return parse(static_cast<int>(argv.size()), argv.data());
}

TEST(RecordOptions, RingsAreNamedInWholeOrByTheirFirstPart) {
  EXPECT_EQ(*choose({}, kThere), kThere);
  EXPECT_EQ(*choose({"camera"}, kThere), Names{"camera.frames"});
  EXPECT_EQ(*choose({"marks", "pose.hands"}, kThere),
            (Names{"pose.hands", "marks.camera", "marks.pose"}));
}

TEST(RecordOptions, ARingThatIsNotThereIsNamedWithThoseThatAre) {
  const auto chosen = choose({"came"}, kThere);
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().what, testing::HasSubstr("no ring 'came'; it has: camera.frames, "));
}

TEST(RecordOptions, RingsAreSeparatedByCommas) {
  const auto options = parsed({"out", "--rings", "camera,pose", "--seconds", "2.5"});
  ASSERT_TRUE(options) << options.error().what;
  EXPECT_EQ(options->options.rings, (Names{"camera", "pose"}));
  EXPECT_EQ(options->options.seconds, 2.5);
}

TEST(RecordOptions, NonsenseIsRefused) {
  EXPECT_FALSE(parsed({}));
  EXPECT_FALSE(parsed({"out", "--seconds", "0"}));
  EXPECT_FALSE(parsed({"out", "--seconds", "nan"}));
  EXPECT_FALSE(parsed({"out", "more"}));
}

}  // namespace
}  // namespace handcast::record
