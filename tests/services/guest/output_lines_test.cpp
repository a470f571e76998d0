// SPDX-License-Identifier: Apache-2.0
#include "services/guest/output_lines.hpp"

#include <gmock/gmock.h>

#include <vector>

namespace handcast::guest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class OutputLinesTest : public testing::Test {
 protected:
  void flood(std::int64_t time_ns) {
    for (int i = 0; i < 1000; ++i) lines_.add("again\n", time_ns);
  }
  std::vector<std::string> passed_;
  OutputLines lines_{[this](std::string_view line) { passed_.emplace_back(line); }};
};

TEST_F(OutputLinesTest, LinesArePassedOnWhenTheyAreWhole) {
  lines_.add("one\n\ntw", 1);
  EXPECT_THAT(passed_, ElementsAre("one"));
  lines_.add("o\nthree", 2);
  EXPECT_THAT(passed_, ElementsAre("one", "two"));
  lines_.finish(3);
  EXPECT_THAT(passed_, ElementsAre("one", "two", "three"));
  EXPECT_EQ(lines_.last(), "three");
}

TEST_F(OutputLinesTest, ALineWithoutEndIsSplit) {
  lines_.add(std::string(10 * OutputLines::kLongestLine, 'x'), 1);
  EXPECT_EQ(passed_.size(), 10u);
}

TEST_F(OutputLinesTest, OfAFloodASentenceASecondIsLeftUntilItEnds) {
  for (int second = 0; second < 3; ++second) flood(second * kSecond_ns);
  EXPECT_EQ(passed_.size(), OutputLines::kMostLines + 2u);
  EXPECT_THAT(passed_.back(), HasSubstr("1000 lines were left out"));
  lines_.add({}, 3 * kSecond_ns);
  lines_.add({}, 4 * kSecond_ns);
  lines_.add("calm\n", 4 * kSecond_ns);
  EXPECT_EQ(passed_.back(), "calm");
}

}  // namespace
}  // namespace handcast::guest
