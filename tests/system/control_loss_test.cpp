// SPDX-License-Identifier: Apache-2.0
// A rig can always be stopped, observed and taken over, whichever of its processes hangs or dies.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>

#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class ControlLoss : public SystemTest {
 protected:
  void expect_darkness(const std::vector<pid_t>& services) const {
    for (const auto pid : services) EXPECT_FALSE(is_alive(pid));
    EXPECT_THAT(traces(), IsEmpty());
    EXPECT_EQ(handcast({"status"}).exit_code, 111);
  }
};

TEST_F(ControlLoss, ASupervisorThatHangsIsReplacedAndTheLightGoesOn) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  const auto hung = rig->supervisor();
  kill(hung, SIGSTOP);
  ASSERT_TRUE(eventually([&] { return rig->supervisor() > 0 && rig->supervisor() != hung; }));
  ASSERT_TRUE(eventually([&] { return !status().is_null(); }));
  EXPECT_EQ(pids(), services);
  expect_more_light();
  EXPECT_THAT(rig->log(), HasSubstr("has given no sign of life"));
}

TEST_F(ControlLoss, DownEndsARigWhoseSupervisorHangs) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  kill(rig->supervisor(), SIGSTOP);
  const auto down = handcast({"down"});
  EXPECT_EQ(down.exit_code, 0) << down.log;
  EXPECT_EQ(rig->wait(), 1);
  expect_darkness(services);
}

TEST_F(ControlLoss, DownEndsARigWhoseSupervisorAndKeeperHang) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  rig->signal(SIGSTOP);
  kill(rig->supervisor(), SIGSTOP);
  const auto down = handcast({"down"});
  EXPECT_EQ(down.exit_code, 0) << down.log;
  rig->wait();
  expect_darkness(services);
}

TEST_F(ControlLoss, CtrlCEndsARigWhoseSupervisorHangs) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  kill(rig->supervisor(), SIGSTOP);
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(), 1);
  expect_darkness(services);
  EXPECT_THAT(rig->log(),
              HasSubstr(fmt::format("its keeper has ended the services that were left: {}",
                                    kServices.size())));
}

TEST_F(ControlLoss, ServicesThatAllHangAreKilledTogether) {
  const auto rig = up({"--set", "supervisor.stop_s=1", "--set", "supervisor.silent_s=300"});
  wait_until_light();
  const auto services = pids();
  for (const auto pid : services) kill(pid, SIGSTOP);
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
  expect_darkness(services);
  EXPECT_THAT(rig->log(), HasSubstr("has not stopped within 1 s"));
}

TEST_F(ControlLoss, ASupervisorThatIsKilledWhileTheRigStopsIsNotReplaced) {
  const auto rig = up({"--set", "supervisor.stop_s=60", "--set", "supervisor.silent_s=300"});
  wait_until_light();
  const auto services = pids();
  const auto supervisor = rig->supervisor();
  for (const auto pid : services) kill(pid, SIGSTOP);
  rig->signal(SIGTERM);
  ASSERT_TRUE(eventually([&] {
    auto now = status();
    return std::ranges::any_of(
        kServices, [&](const auto& name) { return now["services"][name]["state"] == "stopping"; });
  }));
  kill(supervisor, SIGKILL);
  EXPECT_EQ(rig->wait(), 1);
  expect_darkness(services);
}

TEST_F(ControlLoss, StatusShowsADeadKeeperAndUpGivesTheRigANewOne) {
  auto rig = up();
  wait_until_light();
  const auto services = pids();
  rig->signal(SIGKILL);
  rig->wait();
  ASSERT_TRUE(eventually([&] { return status()["keeper_died"] == true; }));
  EXPECT_THAT(handcast({"status"}).output, HasSubstr("the keeper has died"));

  rig = up();
  ASSERT_TRUE(eventually([&] { return status()["keeper_died"] == false; }));
  EXPECT_EQ(pids(), services);
  const auto supervisor = rig->supervisor();
  kill(supervisor, SIGKILL);  // the new keeper does its work
  ASSERT_TRUE(eventually([&] { return rig->supervisor() > 0 && rig->supervisor() != supervisor; }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
}

TEST_F(ControlLoss, ASecondUpOfTheSameNameIsRefusedWhateverTheFolders) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  for (const auto* folder : {"/nowhere", "/tmp"}) {
    const Variable runtime("XDG_RUNTIME_DIR", folder), temporary("TMPDIR", folder);
    const auto second = up();
    EXPECT_EQ(second->wait(), 111);
    EXPECT_THAT(second->log(), HasSubstr("a rig named 'twin' is up already"));
  }
  EXPECT_EQ(pids(), services);
}

// No file of a rig can fill a disk: it has none but the address of its page, which the desk writes
// once, and a folder for what the desk remembers.
TEST_F(ControlLoss, ARigWritesNoFileButTheAddressOfItsPage) {
  const auto folder = scratch_.path() / "empty";
  std::filesystem::create_directory(folder);
  const Variable runtime("XDG_RUNTIME_DIR", folder), temporary("TMPDIR", folder),
      home("HOME", folder);
  const auto rig = up();
  wait_until_light();
  const auto before = service("projector")["pid"].get<pid_t>();
  kill(before, SIGKILL);
  ASSERT_TRUE(eventually([&] {
    const auto now = service("projector");
    return now["pid"] != before && now["state"] == "ready";
  }));
  kill(rig->supervisor(), SIGKILL);
  ASSERT_TRUE(eventually([&] { return !status().is_null(); }));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    EXPECT_TRUE(entry.is_directory() || entry.path().extension() == ".desk") << entry.path();
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

// Restarts are counted over the lives of supervisors.
TEST_F(ControlLoss, RestartsAreCountedAcrossSuccessions) {
  const auto rig = up();
  wait_until_light();
  for (int restarts = 1; restarts <= 2; ++restarts) {
    const auto before = service("pose")["pid"].get<pid_t>();
    kill(before, SIGKILL);
    ASSERT_TRUE(eventually([&] {
      const auto now = service("pose");
      return now["pid"] != before && now["state"] == "ready";
    }));
    const auto supervisor = rig->supervisor();
    kill(supervisor, SIGKILL);
    ASSERT_TRUE(eventually([&] {
      return rig->supervisor() > 0 && rig->supervisor() != supervisor && !status().is_null();
    }));
    EXPECT_EQ(service("pose")["restarts"], restarts);
  }
}

}  // namespace
}  // namespace handcast::system_test
