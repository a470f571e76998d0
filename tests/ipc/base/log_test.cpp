// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/log.hpp"

#include <gmock/gmock.h>

#include "tests/ipc/base/captured_stderr.hpp"

namespace handcast {
namespace {

using handcast::testing::CapturedStderr;
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

TEST(Log, EveryLineOfASentenceOfSeveralLinesHasAPriorityInTheJournal) {
  EXPECT_THAT(written(true, log::Level::error, "two faults:\nthis\nthat"),
              MatchesRegex("<3>[0-9.]+ handcast +error +two faults:\n<3>this\n<3>that\n"));
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
