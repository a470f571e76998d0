// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/log.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include "tests/ipc/base/captured_stderr.hpp"

namespace handcast {
namespace {

using handcast::samples::CapturedStderr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

std::string written(bool to_journal, log::Level level, std::string_view line) {
  CapturedStderr captured(to_journal);
  log::write(level, line);
  return captured.text();
}

TEST(Log, ALineInTheJournalHasThePriorityOfItsLevel) {
  log::set_level(log::Level::debug);
  for (const auto& [level, priority] : {std::pair{log::Level::debug, "<7>"},
                                        {log::Level::info, "<6>"},
                                        {log::Level::warning, "<4>"},
                                        {log::Level::error, "<3>"}})
    EXPECT_THAT(written(true, level, "text"), StartsWith(priority));
  log::set_level(log::Level::info);
}

/// Writes 3 MB of lines to stderr after never_wait_for_stderr(), and only then reads, until a line
/// says how many are missing. Ends the process, after a minute with a signal.
[[noreturn]] void write_to_a_reader_that_sleeps(int reading, int writing) {
  ::alarm(60);
  ::fcntl(reading, F_SETFL, O_NONBLOCK);
  ::dup2(writing, STDERR_FILENO);
  log::never_wait_for_stderr();
  for (int i = 0; i < 30'000; ++i) log::put(std::string(99, '.') + "\n");
  std::string read;
  std::array<char, 4096> bytes;
  while (read.find(" lines that nobody read in time are missing here") == read.npos ||
         read.find("awake") == read.npos) {
    ::usleep(1000);
    for (ssize_t count; (count = ::read(reading, bytes.data(), bytes.size())) > 0;)
      read.append(bytes.data(), static_cast<std::size_t>(count));
    log::put("awake\n");
  }
  const bool is_still_waited_for_elsewhere = (::fcntl(writing, F_GETFL) & O_NONBLOCK) == 0;
  _exit(is_still_waited_for_elsewhere ? 0 : 1);
}

// The last words of a service that died come at once.
TEST(Log, AReaderThatIsMerelySlowerLosesNothing) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const auto lines_of_a_slow_reader = [&] {
    ::alarm(60);
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[1]);
    log::never_wait_for_stderr(std::chrono::seconds(30));
    std::thread writer([&] {
      for (int i = 0; i < 10'000; ++i) log::put(std::string(99, '.') + "\n");
    });
    std::size_t count = 0;
    std::array<char, 1000> bytes;
    while (count < 1'000'000)
      count += static_cast<std::size_t>(::read(ends[0], bytes.data(), bytes.size()));
    writer.join();
    return count;
  };
  EXPECT_EXIT(_exit(lines_of_a_slow_reader() == 1'000'000 ? 0 : 1), ::testing::ExitedWithCode(0),
              "");
}

TEST(Log, APipeThatNobodyReadsIsNotWaitedFor) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  EXPECT_EXIT(write_to_a_reader_that_sleeps(ends[0], ends[1]), ::testing::ExitedWithCode(0), "");
}

TEST(Log, ATerminalThatIsStoppedIsNotWaitedFor) {
  const int reading = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_TRUE(reading >= 0 && ::grantpt(reading) == 0 && ::unlockpt(reading) == 0);
  const int writing = ::open(::ptsname(reading), O_RDWR | O_NOCTTY);
  ASSERT_GE(writing, 0);
  EXPECT_EXIT(write_to_a_reader_that_sleeps(reading, writing), ::testing::ExitedWithCode(0), "");
}

TEST(Log, EveryLineOfASentenceOfSeveralLinesHasAPriorityInTheJournal) {
  EXPECT_THAT(written(true, log::Level::error, "two faults:\nthis\nthat"),
              MatchesRegex("<3>[0-9.]+ handcast +error +two faults:\n<3>  this\n<3>  that\n"));
}

TEST(Log, ElsewhereALineHasNoPriority) {
  EXPECT_THAT(written(false, log::Level::error, "text"),
              MatchesRegex("[0-9.]+ handcast +error +text\n"));
  for (const char* stream : {"", ":", "x:y", "0:0", "99999999999999999999:1"}) {
    CapturedStderr captured(false);
    ::setenv("JOURNAL_STREAM", stream, 1);
    log::error("text");
    EXPECT_THAT(captured.text(), Not(StartsWith("<"))) << stream;
  }
}

TEST(Log, ALineEndInASentenceBeginsNoLineOfTheLog) {
  const auto text =
      written(false, log::Level::info, "page: a\n1.234 desk       error   forged\r\x1b[Kb");
  EXPECT_THAT(text, MatchesRegex("[0-9.]+ handcast +info +page: a\n  1.234 desk +error +forged"
                                 "\\\\x0d\\\\x1b.Kb\n"));
  EXPECT_FALSE(log::parse(text.substr(text.find('\n') + 1)));
}

TEST(Log, ALineCanBeParsedAgainAndOthersCannot) {
  auto line = written(false, log::Level::warning, "the  sentence");
  line.pop_back();  // the end of the line
  const auto parsed = log::parse(line);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->level, log::Level::warning);
  EXPECT_EQ(parsed->sentence, "the  sentence");
  for (const char* other :
       {"", " ", "one", "one two", "1.0 camera", "terminate called after error"})
    EXPECT_FALSE(log::parse(other)) << other;
}

}  // namespace
}  // namespace handcast
