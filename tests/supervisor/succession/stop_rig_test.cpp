// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/stop_rig.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <array>

#include "supervisor/succession/process_discovery.hpp"
#include "tests/supervisor/succession/orphans.hpp"

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class StopRig : public Orphans {
 protected:
  /// A process that has the rig's name and does nothing else.
  pid_t hung_supervisor() {
    std::array<int, 2> ready{};
    EXPECT_EQ(pipe(ready.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      const auto address = control::address_of("desk").value();
      const UniqueFd listener(socket(AF_UNIX, SOCK_STREAM, 0));
      bind(listener.get(), reinterpret_cast<const sockaddr*>(&address.socket), address.size);
      listen(listener.get(), 16);
      [[maybe_unused]] const auto told = write(ready[1], "y", 1);
      for (;;) pause();
    }
    close(ready[1]);
    char word = 0;
    EXPECT_EQ(read(ready[0], &word, 1), 1);
    close(ready[0]);
    return child;
  }
};

TEST(StopReport, ARigOfWhichNothingHadToBeEndedHasSimplyStopped) {
  EXPECT_EQ(describe({.by_supervisor = true, .ended = 0}, "desk"), "the rig has stopped");
  EXPECT_EQ(describe({.by_supervisor = false, .ended = 0}, "desk"), "the rig has stopped");
  EXPECT_EQ(describe({.by_supervisor = false, .ended = 2}, "desk"),
            "rig 'desk' had no supervisor that answered; processes ended: 2");
}

TEST_F(StopRig, ServicesWithoutASupervisorAreEnded) {
  service("exec sleep 1000");
  deaf_service();
  const auto stopped = stop_rig("desk");
  ASSERT_TRUE(stopped) << stopped.error().what;
  EXPECT_FALSE(stopped->by_supervisor);
  EXPECT_EQ(stopped->ended, 2);
  EXPECT_THAT(find_services("desk"), IsEmpty());
}

TEST_F(StopRig, ASupervisorThatHangsIsKilledAndItsServicesAreEnded) {
  service("exec sleep 1000");
  const pid_t supervisor = hung_supervisor();
  const auto stopped = stop_rig("desk");
  ASSERT_TRUE(stopped) << stopped.error().what;
  EXPECT_FALSE(stopped->by_supervisor);
  EXPECT_EQ(stopped->ended, 1);
  int status = 0;
  EXPECT_EQ(waitpid(supervisor, &status, WNOHANG), supervisor);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_THAT(find_services("desk"), IsEmpty());
}

TEST_F(StopRig, ASupervisorThatHangsIsKilledEvenIfItAcceptsNoMoreConnections) {
  const pid_t supervisor = hung_supervisor();
  std::vector<UniqueFd> idle;
  for (auto next = control::connect_to(*control::address_of("desk")); next;
       next = control::connect_to(*control::address_of("desk")))
    idle.push_back(std::move(*next));
  ASSERT_TRUE(control::has_supervisor("desk"));
  const auto stopped = stop_rig("desk");
  ASSERT_TRUE(stopped) << stopped.error().what;
  EXPECT_EQ(waitpid(supervisor, nullptr, WNOHANG), supervisor);
  EXPECT_FALSE(control::has_supervisor("desk"));
}

TEST_F(StopRig, AnInvalidNameIsRefused) {
  const auto stopped = stop_rig("../desk");
  ASSERT_FALSE(stopped);
  EXPECT_THAT(stopped.error().what, HasSubstr("not a valid name"));
}

}  // namespace
}  // namespace handcast::supervisor
