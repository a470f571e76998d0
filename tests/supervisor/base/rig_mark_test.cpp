// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/rig_mark.hpp"

#include <gtest/gtest.h>

namespace handcast::supervisor {
namespace {

/// A command line as /proc/PID/cmdline shows it.
std::string command_line(const std::string& mark) {
  std::string text;
  for (const auto& word : {std::string("/bin/handcast-camera"), std::string("--of-rig"), mark})
    text += word + '\0';
  return text;
}

TEST(RigMark, IsReadAsItWasPrinted) {
  const RigMark mark{.address = "handcast-1000/a:b/desk", .epoch_ns = 42, .network = 4026531840};
  const auto read = mark_in(command_line(print_mark(mark)));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->address, mark.address);
  EXPECT_EQ(read->epoch_ns, 42);
  EXPECT_EQ(read->network, 4026531840u);
  EXPECT_NE(own_network(), 0u);
}

TEST(RigMark, OtherCommandLinesHaveNone) {
  for (const auto* text : {"", "1", "1:", "1:2", "x:2:desk", "1:-:desk"})
    EXPECT_FALSE(mark_in(command_line(text))) << text;
  EXPECT_FALSE(mark_in(std::string("/bin/sleep\0001000\0", 15)));
  EXPECT_FALSE(mark_in("/bin/handcast-camera --of-rig 1:2:desk"));
}

}  // namespace
}  // namespace handcast::supervisor
