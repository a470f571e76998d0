// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/handover.hpp"

#include <gmock/gmock.h>

#include "tests/ipc/daemon/daemon_environment.hpp"

namespace handcast::daemon {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(Handover, ADaemonReadsWhatItsSupervisorWrote) {
  const Handover handover{.rings = {{"pose.hands", 61}, {"camera.frames", 5}},
                          .ready_fd = 7,
                          .standby_fd = 8,
                          .epoch_ns = 123456789012345};
  const DaemonEnvironment environment(handover);
  const auto read = from_environment();
  EXPECT_EQ(read.rings, handover.rings);
  EXPECT_EQ(read.ready_fd, 7);
  EXPECT_EQ(read.standby_fd, 8);
  EXPECT_EQ(read.epoch_ns, 123456789012345);
}

TEST(Handover, ADaemonThatIsNoStandbyIsNotToldOfAStandbyDescriptor) {
  const DaemonEnvironment environment({.ready_fd = 7, .epoch_ns = 1});
  EXPECT_EQ(getenv("HANDCAST_STANDBY_FD"), nullptr);
  EXPECT_EQ(from_environment().standby_fd, -1);
}

TEST(Handover, StartedByHandADaemonHasNothing) {
  const DaemonEnvironment environment({});
  const auto read = from_environment();
  EXPECT_THAT(read.rings, IsEmpty());
  EXPECT_EQ(read.ready_fd, -1);
  EXPECT_EQ(read.standby_fd, -1);
  EXPECT_EQ(read.epoch_ns, std::nullopt);
}

TEST(Handover, NumbersThatMakeNoSenseCountAsUnset) {
  const DaemonEnvironment environment({});
  for (const auto* value : {"", "seven", "7x", "-3", "99999999999999999999"}) {
    setenv(kReadyVariable, value, 1);
    EXPECT_EQ(from_environment().ready_fd, -1) << value;
  }
}

TEST(Rings, AreReadAndNonsenseIsLeftOut) {
  EXPECT_THAT(parse_rings("camera.frames=5,pose.hands=61"),
              ElementsAre(Pair("camera.frames", 5), Pair("pose.hands", 61)));
  EXPECT_THAT(parse_rings(""), IsEmpty());
  EXPECT_THAT(parse_rings("=5,a,b=,c=x,d=-1,e=7z,f=7"), ElementsAre(Pair("f", 7)));
}

TEST(Rings, AStreamIsFoundByItsWholeName) {
  const Rings rings{{"camera.frames", 5}, {"camera", 6}};
  EXPECT_EQ(find_ring(rings, "camera"), 6);
  EXPECT_EQ(find_ring(rings, "frames"), std::nullopt);
}

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
}  // namespace handcast::daemon
