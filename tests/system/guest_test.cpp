// SPDX-License-Identifier: Apache-2.0
// A program of somebody else that the rig starts: [pose.external] command.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>

#include "ipc/client/rig_ring.hpp"
#include "ipc/control/rig_address.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A tracker in Python that sees no hands. It tells its pid in a file.
constexpr const char* kTracker = R"(
import os, time, handcast
with open("pid", "w") as file:
    file.write(str(os.getpid()))
rig = handcast.Rig()
print("the tracker sees", flush=True)
while True:
    rig.pose.publish({}, handcast.now_ns())
    time.sleep(0.01)
)";

/// What makes it leave its ring late.
constexpr const char* kLeavesLate = R"(
import signal, sys, time
def leave(*_):
    time.sleep(0.8)
    sys.exit()
signal.signal(signal.SIGTERM, leave)
)";

class Guest : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0)
      GTEST_SKIP() << "numpy is not installed";
  }
  std::unique_ptr<Command> up_with(const std::string& command, const Arguments& more = {}) const {
    Arguments arguments{"--set", "pose.backend=external",
                        "--set", "pose.external.command=" + command,
                        "--set", "pose.external.folder=" + scratch_.path().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return up(arguments);
  }
  std::unique_ptr<Command> up_with_script(const std::string& script,
                                          const Arguments& more = {}) const {
    std::ofstream(scratch_.path() / "my_tracker.py") << script;
    return up_with(R"(["/usr/bin/python3", "my_tracker.py"])", more);
  }
  /// The pid of the tracker if it is another one than `before`; 0 if there is none.
  pid_t tracker(pid_t before = 0) const {
    pid_t pid = 0;
    std::ifstream(scratch_.path() / "pid") >> pid;
    return pid != before && pid > 0 && is_alive(pid) ? pid : 0;
  }
  bool works() const { return service("pose_guest")["state"] == "ready"; }
  /// Whether `handcast status` prints this.
  bool is_said(const std::string& text) const {
    return eventually([&] { return handcast({"status"}).output.find(text) != std::string::npos; });
  }
  /// Light goes on, and no other service died.
  void expect_no_harm() const {
    wait_until_light();
    expect_more_light();
    for (const auto& name : kServices) EXPECT_EQ(service(name)["restarts"], 0) << name;
  }
};

TEST_F(Guest, IsStartedWithTheRigStartedAgainAndStoppedWithIt) {
  const auto rig = up_with_script(kTracker);
  ASSERT_TRUE(eventually([&] { return tracker() != 0 && works(); })) << rig->log();
  EXPECT_TRUE(is_said("the tracker sees"));
  EXPECT_THAT(rig->log(), HasSubstr("the tracker sees"));
  const auto first = tracker();
  kill(first, SIGKILL);
  ASSERT_TRUE(eventually([&] { return tracker(first) != 0 && works(); })) << rig->log();
  EXPECT_GE(service("pose_guest")["restarts"], 1);
  expect_no_harm();
  const auto second = tracker();
  const auto before_stop = rig->log().size();
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_FALSE(is_alive(second));
  EXPECT_THAT(rig->log().substr(before_stop), Not(HasSubstr("nothing was sent")));
  EXPECT_THAT(traces(), testing::IsEmpty());
}

TEST_F(Guest, DiesWithTheProcessThatWatchesIt) {
  const auto rig = up_with_script(kTracker);
  ASSERT_TRUE(eventually([&] { return tracker() != 0 && works(); })) << rig->log();
  const auto first = tracker();
  kill(service("pose_guest")["pid"].get<pid_t>(), SIGKILL);
  EXPECT_TRUE(eventually([&] { return !is_alive(first); }));
  EXPECT_TRUE(eventually([&] { return tracker(first) != 0 && works(); })) << rig->log();
}

TEST_F(Guest, OneThatCrashesAtOnceIsNamedWithItsLastLine) {
  const auto rig = up_with_script("raise SystemExit('no camera is attached')");
  EXPECT_TRUE(is_said("the program has ended: exit 1: no camera is attached")) << rig->log();
  EXPECT_TRUE(is_said("tried again in"));
  expect_no_harm();
}

TEST_F(Guest, OneThatIsNotThereIsNamed) {
  const auto rig = up_with(R"(["no_such_program"])");
  EXPECT_TRUE(is_said("'no_such_program' cannot be started")) << rig->log();
  expect_no_harm();
}

TEST_F(Guest, OneThatFloodsItsOutputFillsNoLog) {
  const auto rig = up_with_script("while True: print('again')");
  EXPECT_TRUE(is_said("it prints too much")) << rig->log().substr(0, 2000);
  expect_no_harm();
  EXPECT_LT(rig->log().size(), 100'000u);
}

TEST_F(Guest, OneThatFallsSilentIsStartedAgain) {
  const auto rig = up_with_script(
      "import time, handcast\n"
      "handcast.Rig().pose.publish({}, handcast.now_ns())\n"
      "print('waits for its device')\n"
      "time.sleep(1000)\n",
      {"--set", "pose.external.silent_s=1"});
  EXPECT_TRUE(
      is_said("it has sent nothing to guest.pose for 1 s; its last line: waits for its device"))
      << rig->log();
  expect_no_harm();
}

TEST_F(Guest, AReloadStartsTheNextOneWhenTheLastOneHasLeft) {
  std::ofstream(scratch_.path() / "my_tracker.py") << kLeavesLate << kTracker;
  const auto rig_file = scratch_.path() / "rig.toml";
  const auto write = [&](const char* silent_s) {
    std::ofstream(rig_file) << "name = 'twin'\ncamera.rate_hz = 60\nprojector.rate_hz = 60\n"
                               "landmarks.backend = 'twin'\n[pose]\nbackend = 'external'\n"
                               "external.command = ['/usr/bin/python3', 'my_tracker.py']\n"
                               "external.silent_s = "
                            << silent_s << "\n";
  };
  write("10");
  const Command rig(scratch_.path(), {"up", rig_file});
  ASSERT_TRUE(eventually([&] { return tracker() != 0 && works(); })) << rig.log();
  const auto first = tracker();
  write("11");
  EXPECT_EQ(handcast({"reload"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return tracker(first) != 0 && works(); })) << rig.log();
  EXPECT_EQ(service("pose_guest")["restarts"], 0) << rig.log();
}

TEST_F(Guest, NoiseInTheHeaderOfItsRingDoesNotOutliveARestart) {
  const auto rig = up({"--set", "pose.backend=external"});
  wait_until_light();
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  const auto ring = client::rig_ring("", "guest.pose");
  ASSERT_TRUE(ring) << ring.error().what;
  const std::string noise(4096, '\xa5');
  ASSERT_EQ(pwrite(ring->segment.fd(), noise.data(), noise.size(), 0), 4096);
  const auto before = service("pose")["pid"];
  kill(before.get<pid_t>(), SIGKILL);
  EXPECT_TRUE(eventually([&] {
    const auto pose = service("pose");
    return pose["state"] == "ready" && pose["pid"] != before;
  })) << rig->log();
}

}  // namespace
}  // namespace handcast::system_test
