// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/console.hpp"

#include <gtest/gtest.h>

#include "tests/ipc/base/captured_stderr.hpp"

namespace handcast::supervisor {
namespace {

std::string printed(bool to_journal, std::string_view line) {
  handcast::samples::CapturedStderr captured(to_journal);
  print_line(line);
  return captured.text();
}

TEST(Console, ALineOfAServiceHasOnePriorityInTheJournalThatOfItsLevel) {
  EXPECT_EQ(printed(true, "1.2 camera     warning late"), "<4>1.2 camera     warning late\n");
  EXPECT_EQ(printed(true, "1.2 camera     error   gone"), "<3>1.2 camera     error   gone\n");
  EXPECT_EQ(printed(true, "1.2 camera     info    ready"), "<6>1.2 camera     info    ready\n");
}

TEST(Console, OtherLinesHaveThePriorityOfWhatTheyAre) {
  EXPECT_EQ(printed(true, "handcast: camera cannot start"), "<3>handcast: camera cannot start\n");
  EXPECT_EQ(printed(true, "a library says"), "<6>a library says\n");
  EXPECT_EQ(printed(true, "<0>a service says"), "<6><0>a service says\n");
}

TEST(Console, ElsewhereALineIsAsItIs) {
  EXPECT_EQ(printed(false, "1.2 camera     warning late"), "1.2 camera     warning late\n");
}

TEST(Console, WhatALibraryPrintsDoesNotMoveTheCursor) {
  EXPECT_EQ(printed(false, "title:\r\x1b[2A\tdone"), "title:\\x0d\\x1b[2A\tdone\n");
}

}  // namespace
}  // namespace handcast::supervisor
