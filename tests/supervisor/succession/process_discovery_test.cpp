// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/process_discovery.hpp"

#include <gmock/gmock.h>
#include <signal.h>

#include "supervisor/base/pidfd.hpp"
#include "supervisor/life/process_activity.hpp"
#include "tests/supervisor/succession/orphans.hpp"

namespace handcast::supervisor {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

using ProcessDiscovery = Orphans;

TEST_F(ProcessDiscovery, AServiceIsFoundByItsEnvironment) {
  auto& child = service("sleep 1000; true", 42);
  const auto found = find_services("desk");
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].pid, child.pid());
  EXPECT_EQ(found[0].rig, "desk");
  EXPECT_EQ(found[0].service, "bash");  // the name of the program without "handcast-"
  EXPECT_EQ(found[0].epoch_ns, 42);
  EXPECT_EQ(found[0].state_fd, 2);
  EXPECT_THAT(find_services("sofa"), IsEmpty());
  child.signal(SIGKILL);
  EXPECT_TRUE(ends_within(found[0].pidfd, 20));
  EXPECT_THAT(find_services("desk"), IsEmpty());  // a zombie is no service
}

TEST_F(ProcessDiscovery, AnInstanceOfAProgramHasItsOwnName) {
  service("sleep 1000; true", now_ns(), {"handcast-camera", "--as", "camera2", "--config", "x"});
  const auto found = find_services("desk");
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].service, "camera2");
}

TEST_F(ProcessDiscovery, TheProcessesThatAServiceStartsAreNotServices) {
  service("sleep 1000 & sleep 1000");
  usleep(50'000);
  EXPECT_THAT(find_services("desk"), SizeIs(1));
}

TEST_F(ProcessDiscovery, ARigOfAnotherScopeIsNotFound) {
  service("exec sleep 1000");
  setenv(control::kScopeVariable, "another", 1);
  EXPECT_THAT(find_services(), IsEmpty());
}

TEST_F(ProcessDiscovery, ServicesAreAskedAndThenKilled) {
  auto& polite = service("exec sleep 1000");
  auto& deaf = deaf_service();
  EXPECT_EQ(end_services("sofa", 0, now_ns()), 0);
  EXPECT_EQ(end_services("desk", 0.3, now_ns()), 2);
  EXPECT_EQ(polite.try_reap()->code, SIGTERM);
  EXPECT_EQ(deaf.try_reap()->code, SIGKILL);
  EXPECT_THAT(find_services("desk"), IsEmpty());
}

TEST_F(ProcessDiscovery, AStoppedServiceIsEndedToo) {
  auto& child = service("exec sleep 1000");
  child.signal(SIGSTOP);
  while (!look_at_process(child.pid())->all_stopped) usleep(1000);
  EXPECT_EQ(end_services("desk", 0.1, now_ns()), 1);
  EXPECT_EQ(child.try_reap()->code, SIGKILL);
}

TEST_F(ProcessDiscovery, ARigThatWasStartedSinceIsLeftAlone) {
  const auto before_ns = now_ns();
  auto& child = service("exec sleep 1000", before_ns + 1);
  EXPECT_EQ(end_services("desk", 0, before_ns), 0);
  EXPECT_FALSE(child.has_ended());
}

}  // namespace
}  // namespace handcast::supervisor
