#include "supervisor/life/log_tail.hpp"

#include <gmock/gmock.h>

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

void ignore(std::string_view) {}

TEST(LogTail, LinesComeOutWholeHoweverTheBytesArrive) {
  std::vector<std::string> seen;
  const auto note = [&](std::string_view line) { seen.emplace_back(line); };
  LogTail tail;
  tail.append("fi", note);
  EXPECT_THAT(seen, IsEmpty());
  tail.append("rst\nsecond\nthi", note);
  EXPECT_THAT(seen, ElementsAre("first", "second"));
}

TEST(LogTail, KeepsTheNewestTwoHundredLines) {
  LogTail tail;
  for (int i = 0; i < 1000; ++i) tail.append(std::to_string(i) + "\n", ignore);
  EXPECT_EQ(tail.last(10000).size(), LogTail::kLines);
  EXPECT_THAT(tail.last(2), ElementsAre("998", "999"));
}

TEST(LogTail, ALineWithoutEndDoesNotGrowWithoutEnd) {
  LogTail tail;
  tail.append(std::string(3 * LogTail::kLongestLine, 'x'), ignore);
  EXPECT_EQ(tail.last(10).size(), 3u);
}

TEST(LogTail, TheLastSentenceIsWhatThePersonShouldRead) {
  LogTail tail;
  EXPECT_EQ(tail.last_sentence(), "");
  tail.append("12.345 camera     error   camera 'A-2134': no such device\n", ignore);
  EXPECT_EQ(tail.last_sentence(), "camera 'A-2134': no such device");
  tail.append("Segmentation fault in the driver\n", ignore);
  EXPECT_EQ(tail.last_sentence(), "Segmentation fault in the driver");
}

}  // namespace
}  // namespace handcast::supervisor
