// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/log_tail.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include "ipc/base/log.hpp"
#include "ipc/base/unique_fd.hpp"

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

TEST(LogTail, WhatFollowsACutIsNoLineOfTheLog) {
  LogTail tail;
  const std::string forged = "1.2 camera     error   forged";
  tail.append(std::string(LogTail::kLongestLine, 'x') + forged + "\n", ignore);
  EXPECT_EQ(tail.last(1).front(), "  " + forged);
  EXPECT_FALSE(log::parse(tail.last(1).front()));
  EXPECT_EQ(tail.last_sentence(), forged);
}

TEST(LogTail, TheLastSentenceIsWhatThePersonShouldRead) {
  LogTail tail;
  EXPECT_EQ(tail.last_sentence(), "");
  tail.append("12.345 camera     error   camera 'A-2134': no such device\n", ignore);
  EXPECT_EQ(tail.last_sentence(), "camera 'A-2134': no such device");
  tail.append("Segmentation fault in the driver\n", ignore);
  EXPECT_EQ(tail.last_sentence(), "Segmentation fault in the driver");
}

TEST(LogTail, AnErrorThatIsRepeatedIsPrintedShortAndKeptWhole) {
  std::vector<std::string> seen;
  const auto note = [&](std::string_view line) { seen.emplace_back(line); };
  LogTail tail;
  tail.append("1.000 pose       error   there is no runtime\n", note);
  tail.append("2.000 pose       error   there is no runtime\n", note);
  tail.append("3.000 pose       error   there is no hand\n", note);
  tail.append("4.000 pose       warning there is no hand\n", note);
  EXPECT_THAT(seen, ElementsAre("1.000 pose       error   there is no runtime",
                                "2.000 pose       error   as before",
                                "3.000 pose       error   there is no hand",
                                "4.000 pose       warning there is no hand"));
  EXPECT_EQ(tail.last(3).front(), "2.000 pose       error   there is no runtime");
}

TEST(LogTail, OfAServiceThatWaitsWhatWasSaidIsNotSaidAgain) {
  std::vector<std::string> seen;
  const auto note = [&](std::string_view line) { seen.emplace_back(line); };
  LogTail tail;
  const auto life = [&](const std::string& time) {
    tail.append(time + " camera     warning priority 50 is not permitted\n", note);
    tail.append(time + " camera     error   no camera is attached\n", note);
  };
  life("1.000");
  tail.leave_out_known(true);
  life("2.000");
  life("3.000");
  tail.append("4.000 camera     error   it is used by another program\n", note);
  life("5.000");
  EXPECT_THAT(seen, ElementsAre("1.000 camera     warning priority 50 is not permitted",
                                "1.000 camera     error   no camera is attached",
                                "4.000 camera     error   it is used by another program"));
  EXPECT_EQ(tail.last_sentence(), "no camera is attached") << "`handcast status` shows the newest";
  tail.leave_out_known(false);
  life("6.000");
  EXPECT_EQ(seen.size(), 5u);
}

TEST(LogTail, OneThatWritesFasterThanItIsReadIsNotReadForEver) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_NONBLOCK), 0);
  const UniqueFd reader(ends[0]);
  UniqueFd writer(ends[1]);
  ASSERT_GE(fcntl(writer.get(), F_SETPIPE_SZ, 1 << 18), 1 << 18);
  const std::string lines(1 << 18, '\n');
  ASSERT_EQ(::write(writer.get(), lines.data(), lines.size()), 1 << 18);
  writer.reset();

  int seen = 0;
  const auto count = [&](std::string_view) { ++seen; };
  LogTail tail;
  EXPECT_TRUE(tail.read_from(reader.get(), count));
  EXPECT_LT(seen, 1 << 18) << "what is left is read at the next turn";
  EXPECT_FALSE(tail.read_from(reader.get(), count, LogTail::kAllReads));
  EXPECT_EQ(seen, 1 << 18);
}

}  // namespace
}  // namespace handcast::supervisor
