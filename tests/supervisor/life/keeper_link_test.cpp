// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/keeper_link.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <array>

namespace handcast::supervisor {
namespace {

class KeeperLinkTest : public testing::Test {
 protected:
  void SetUp() override {
    std::array<int, 2> ends{};
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
    keeper_ = UniqueFd(ends[0]);
    setenv(kKeeperVariable, std::to_string(ends[1]).c_str(), 1);
    link_ = KeeperLink::from_environment();
  }
  void tell(ExitReport report) const {
    ASSERT_EQ(send(keeper_.get(), &report, sizeof report, 0), static_cast<ssize_t>(sizeof report));
  }

  UniqueFd keeper_;
  KeeperLink link_;
};

TEST_F(KeeperLinkTest, EachEndIsToldOnce) {
  tell({11, CLD_EXITED, 100});
  tell({12, CLD_KILLED, SIGSEGV});
  tell({13, CLD_DUMPED, SIGABRT});
  EXPECT_EQ(link_.take(11), std::nullopt);  // not read yet
  link_.read();
  EXPECT_TRUE(link_.take(11)->asks_for_a_person());
  EXPECT_EQ(link_.take(12)->describe(), "signal 11 (Segmentation fault)");
  EXPECT_TRUE(link_.take(13)->signalled);
  EXPECT_EQ(link_.take(11), std::nullopt);
  EXPECT_EQ(link_.take(99), std::nullopt);
}

TEST_F(KeeperLinkTest, ServicesDoNotInheritTheSocket) {
  EXPECT_EQ(getenv(kKeeperVariable), nullptr);
  EXPECT_EQ(fcntl(link_.fd(), F_GETFD), FD_CLOEXEC);
}

TEST_F(KeeperLinkTest, ABeatTellsTheKeeperTheRigAndWhetherItStops) {
  for (const bool stopping : {false, true}) {
    link_.beat("desk", stopping);
    Beat beat;
    ASSERT_EQ(recv(keeper_.get(), &beat, sizeof beat, MSG_DONTWAIT), sizeof beat);
    EXPECT_STREQ(beat.rig.data(), "desk");
    EXPECT_EQ(beat.stopping, stopping);
  }
}

TEST_F(KeeperLinkTest, TheKeepersDeathIsNoticedAndNoKeeperIsNotADeadOne) {
  EXPECT_FALSE(link_.keeper_died());
  keeper_.reset();
  link_.read();
  EXPECT_TRUE(link_.keeper_died());
  EXPECT_FALSE(KeeperLink::from_environment().keeper_died());
}

TEST_F(KeeperLinkTest, WhatIsNoReportIsPassedOver) {
  send(keeper_.get(), "gossip", 6, 0);
  tell({11, CLD_EXITED, 0});
  link_.read();
  EXPECT_TRUE(link_.take(11)->is_success());
}

TEST_F(KeeperLinkTest, AKeeperThatDiesLeavesItsLastReports) {
  tell({11, CLD_EXITED, 3});
  keeper_.reset();
  link_.read();
  EXPECT_EQ(link_.take(11)->code, 3);
  EXPECT_EQ(link_.fd(), -1);
  link_.read();
}

TEST(KeeperLink, WithoutAKeeperThereIsNothingToRead) {
  for (const auto* value : {"", "two", "-1", "1", "9999", "12abc"}) {
    setenv(kKeeperVariable, value, 1);
    auto link = KeeperLink::from_environment();
    EXPECT_EQ(link.fd(), -1) << value;
    link.read();
  }
}

TEST(KeeperLink, ManyThatNobodyAsksAboutDoNotFillTheMemory) {
  std::array<int, 2> ends{};
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
  const UniqueFd keeper(ends[0]);
  setenv(kKeeperVariable, std::to_string(ends[1]).c_str(), 1);
  auto link = KeeperLink::from_environment();
  int left = 0;
  for (pid_t pid = 2; pid < 5000; ++pid) {
    const ExitReport report{pid, CLD_EXITED, 0};
    ASSERT_EQ(send(keeper.get(), &report, sizeof report, 0), static_cast<ssize_t>(sizeof report));
    link.read();
  }
  for (pid_t pid = 2; pid < 5000; ++pid) left += link.take(pid) ? 1 : 0;
  EXPECT_GT(left, 0);
  EXPECT_LE(left, 1024);
}

TEST(ExitToldByKernel, IsThatOfAProcessSomebodyElseReaped) {
  for (const int code : {0, 42}) {
    const pid_t child = fork();
    if (child == 0) {
      if (code == 0) kill(getpid(), SIGKILL);
      _exit(code);
    }
    const UniqueFd pidfd(static_cast<int>(syscall(SYS_pidfd_open, child, 0)));
    waitpid(child, nullptr, 0);
    const auto exit = exit_told_by_kernel(pidfd.get());
    if (!exit) GTEST_SKIP() << "this kernel does not tell (it does from Linux 6.15 on)";
    EXPECT_EQ(exit->signalled, code == 0);
    EXPECT_EQ(exit->code, code == 0 ? SIGKILL : code);
  }
}

}  // namespace
}  // namespace handcast::supervisor
