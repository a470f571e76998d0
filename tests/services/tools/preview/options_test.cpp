// SPDX-License-Identifier: Apache-2.0
#include "services/tools/preview/options.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace handcast::preview {
namespace {

Result<Parsed> parse_words(std::vector<std::string> words) {
  std::vector<char*> pointers{const_cast<char*>("handcast-preview")};
  for (auto& word : words) pointers.push_back(word.data());
  return parse(static_cast<int>(pointers.size()), pointers.data());
}

TEST(PreviewOptions, AreReadFromTheCommandLine) {
  const auto parsed = parse_words({"--rig", "twin", "--shot", "a.png", "--after", "0.5", "--layers",
                                   "image", "--size", "640x480", "--second-projector"});
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->options.rig, "twin");
  EXPECT_EQ(parsed->options.shot, "a.png");
  EXPECT_EQ(parsed->options.after_s, 0.5);
  EXPECT_EQ(parsed->options.look.layers.to_ulong(), 1u);
  EXPECT_EQ(parsed->options.look.width_px, 640);
  EXPECT_EQ(parsed->options.look.height_px, 480);
  EXPECT_EQ(parsed->options.projector, config::Viewpoint::second);
}

TEST(PreviewOptions, NonsenseIsRefusedWithASentence) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--size", "640"},
                                                {"--size", "640x"},
                                                {"--size", "640x480x"},
                                                {"--size", "1x1"},
                                                {"--size", "99999x99999"},
                                                {"--size", "-640x480"},
                                                {"--after", "-1"},
                                                {"--after", "nan"},
                                                {"--after", "soon"},
                                                {"--layers", "hands"},
                                                {"--shots", "a.png"},
                                                {"twin"}}) {
    const auto parsed = parse_words(words);
    EXPECT_FALSE(parsed) << words.front() << " " << words.back();
    EXPECT_TRUE(parsed || !parsed.error().what.empty());
  }
}

TEST(PreviewOptions, HelpAndVersionArePrinted) {
  EXPECT_THAT(parse_words({"--help"})->text, testing::HasSubstr("--shot"));
  EXPECT_THAT(parse_words({"--version"})->text, testing::HasSubstr("handcast preview"));
}

}  // namespace
}  // namespace handcast::preview
