// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/child.hpp"

#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/wait.h>

#include "supervisor/base/event_loop.hpp"
#include "supervisor/base/process.hpp"
#include "tests/supervisor/life/output_of.hpp"

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;
using testing::Not;

Result<Child> shell(const std::string& script,
                    std::vector<std::pair<std::string, int>> rings = {}) {
  return Child::spawn({.program = "/bin/bash",
                       .arguments = {"-c", script},
                       .rings = std::move(rings),
                       .epoch_ns = 42});
}

Exit wait_for(Child& child) {
  pollfd ended{.fd = child.pidfd(), .events = POLLIN, .revents = 0};
  poll(&ended, 1, 20000);
  return child.try_reap().value_or(Exit{.signalled = true, .code = -1});
}

/// Waits until there is no such process, or only a zombie.
bool goes(pid_t pid) {
  for (int i = 0; i < 1000; ++i) {
    if (kill(pid, 0) != 0 || !start_ticks_of(pid)) return true;
    usleep(10'000);
  }
  return false;
}

TEST(Child, ExitCodesAndSignalsAreToldApart) {
  auto hundred = shell("exit 100").value();
  EXPECT_TRUE(wait_for(hundred).asks_for_a_person());
  auto killed = shell("kill -9 $$").value();
  const auto exit = wait_for(killed);
  EXPECT_TRUE(exit.signalled);
  EXPECT_EQ(exit.code, SIGKILL);
}

TEST(Child, AMissingProgramIsASentenceAndNotAProcess) {
  const auto child =
      Child::spawn({.program = "/nowhere/handcast-camera", .arguments = {}, .rings = {}});
  ASSERT_FALSE(child);
  EXPECT_EQ(child.error().code, Errc::bad_config);
  EXPECT_THAT(child.error().what, HasSubstr("/nowhere/handcast-camera"));
}

TEST(Child, TheContractStandsInTheEnvironment) {
  const UniqueFd memory(memfd_create("ring", MFD_CLOEXEC));
  ASSERT_EQ(ftruncate(memory.get(), 4096), 0);
  const auto child = shell(
      "echo $HANDCAST_EPOCH_NS; echo $HANDCAST_RINGS; fd=${HANDCAST_RINGS#*=}; readlink "
      "/proc/self/fd/$fd; echo >&$HANDCAST_READY_FD",
      {{"camera.frames", memory.get()}});
  ASSERT_TRUE(child);
  pollfd ready{.fd = child->ready_fd(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(poll(&ready, 1, 20000), 1);
  char byte = 0;
  ASSERT_EQ(::read(child->ready_fd(), &byte, 1), 1);
  EXPECT_EQ(byte, '\n');
  std::string log(1000, '\0');
  log.resize(static_cast<std::size_t>(
      std::max<ssize_t>(::read(child->log_fd(), log.data(), log.size()), 0)));
  EXPECT_THAT(log, HasSubstr("42\ncamera.frames="));
  EXPECT_THAT(log, HasSubstr("memfd:ring"));
}

TEST(Child, NothingOfTheSupervisorLeaksIntoAService) {
  const UniqueFd secret(memfd_create("secret", MFD_CLOEXEC));
  sigset_t before;
  sigprocmask(SIG_SETMASK, nullptr, &before);
  const auto blocked_here = open_stop_signals();
  const auto output =
      test::output_of("/bin/bash", {"-c", "ls -l /proc/self/fd; grep -i sigblk /proc/self/status"});
  sigprocmask(SIG_SETMASK, &before, nullptr);
  EXPECT_THAT(output, Not(HasSubstr("secret")));
  EXPECT_THAT(output, Not(HasSubstr("signalfd")));
  EXPECT_THAT(output, HasSubstr("SigBlk:\t0000000000000000"));
}

TEST(Child, GrandchildrenEndWithTheService) {
  auto child = shell("sleep 1000 & echo $!").value();
  const auto exit = wait_for(child);
  EXPECT_TRUE(exit.is_success());
  char text[32] = {};
  ASSERT_GT(::read(child.log_fd(), text, sizeof text - 1), 0);
  const pid_t grandchild = atoi(text);
  for (int i = 0; i < 1000 && kill(grandchild, 0) == 0; ++i) {
    std::string state(200, '\0');
    if (FILE* file = fopen(("/proc/" + std::to_string(grandchild) + "/stat").c_str(), "r")) {
      state.resize(fread(state.data(), 1, state.size(), file));
      fclose(file);
      if (state.find(") Z ") != std::string::npos)
        return;  // dead; whoever adopted it has not looked yet
    }
    usleep(10000);
  }
  EXPECT_NE(kill(grandchild, 0), 0);
}

TEST(Child, AStandbyGetsItsTurnThroughADescriptorOfItsOwn) {
  auto child =
      Child::spawn(
          {.program = "/bin/bash",
           .arguments = {"-c", "read -n 1 -u $HANDCAST_STANDBY_FD turn || exit 3; exit $turn"},
           .rings = {},
           .standby = true})
          .value();
  EXPECT_FALSE(child.try_reap());
  child.give_turn();
  EXPECT_EQ(wait_for(child).code, 1) << "its turn is the byte '1'";
}

TEST(Child, AStandbySeesTheEndOfItsSupervisor) {
  pid_t standby = 0;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const auto supervisor = fork();
  if (supervisor == 0) {
    auto child =
        Child::spawn({.program = "/bin/bash",
                      .arguments = {"-c", "read -n 1 -u $HANDCAST_STANDBY_FD turn || exit 0"},
                      .rings = {},
                      .standby = true});
    const pid_t pid = child ? child->pid() : 0;
    _exit(write(ends[1], &pid, sizeof pid) == sizeof pid
              ? 0
              : 1);  // without destructors, as by SIGKILL
  }
  close(ends[1]);
  ASSERT_EQ(read(ends[0], &standby, sizeof standby), static_cast<ssize_t>(sizeof standby));
  waitpid(supervisor, nullptr, 0);
  EXPECT_TRUE(goes(standby));
}

TEST(Child, AServiceOutlivesItsSupervisor) {
  pid_t service = 0;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const auto supervisor = fork();
  if (supervisor == 0) {
    const auto child = shell("exec sleep 1000");
    const pid_t pid = child ? child->pid() : 0;
    _exit(write(ends[1], &pid, sizeof pid) == sizeof pid ? 0 : 1);
  }
  close(ends[1]);
  ASSERT_EQ(read(ends[0], &service, sizeof service), static_cast<ssize_t>(sizeof service));
  waitpid(supervisor, nullptr, 0);
  usleep(50'000);  // a death signal would long be there
  EXPECT_EQ(kill(service, 0), 0);
  EXPECT_EQ(getsid(service), service) << "leader of its own session";
  kill(service, SIGKILL);
}

TEST(Child, TheEndOfAnAdoptedProcessThatNobodyReportsIsUnknown) {
  unsetenv("HANDCAST_KEEPER_FD");
  auto link = KeeperLink::from_environment();
  auto other = shell("exec sleep 1000").value();
  AdoptedProcess process;
  process.saved.pid = other.pid();
  process.pidfd = UniqueFd(dup(other.pidfd()));
  auto adopted = Child::adopt(std::move(process), link);
  EXPECT_FALSE(adopted.try_reap());
  adopted.signal(SIGTERM);
  auto exit = adopted.try_reap();
  for (int i = 0; i < 1000 && !exit; ++i) {
    usleep(10'000);
    exit = adopted.try_reap();
  }
  ASSERT_TRUE(exit);
  EXPECT_TRUE(exit->unknown) << exit->describe();
}

TEST(Child, AServiceNeverWaitsForItsSupervisorToRead) {
  auto child =
      shell("for ((i = 0; i < 20000; ++i)); do echo 0123456789 2>/dev/null; done; exit 7").value();
  EXPECT_EQ(wait_for(child).code, 7) << "200 KB into a pipe of 64 KB that nobody reads";
}

}  // namespace
}  // namespace handcast::supervisor
