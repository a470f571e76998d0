// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "tests/scratch.hpp"

namespace handcast::supervisor {
namespace {

TEST(StartTicks, TellAProcessFromNoneAndFromAZombie) {
  const auto mine = start_ticks_of(getpid());
  ASSERT_TRUE(mine);
  EXPECT_GT(*mine, 0u);
  const pid_t child = fork();
  if (child == 0) {
    pause();
    _exit(0);
  }
  EXPECT_GE(start_ticks_of(child).value_or(0), *mine);
  kill(child, SIGKILL);
  siginfo_t info{};
  waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT);
  EXPECT_EQ(start_ticks_of(child), std::nullopt);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(start_ticks_of(child), std::nullopt);
}

TEST(StartTicks, AreATimeOnTheClockOfTheRig) {
  const auto started_ns = start_ns_of(start_ticks_of(getpid()).value());
  EXPECT_LE(started_ns, now_ns());
  EXPECT_GT(started_ns, now_ns() - seconds_to_ns(3600)) << "this test has just been started";
}

TEST(ProcText, IsEmptyWhereReadingFailsAfterOpening) {
  const handcast::test::Scratch scratch;
  std::filesystem::create_directory(scratch.path() / "stat");  // opens, but cannot be read
  EXPECT_EQ(proc_text(scratch.path() / "stat"), "");
  EXPECT_EQ(stat_field(scratch.path(), 3), "");
  EXPECT_EQ(proc_text(scratch.path() / "absent"), "");
  EXPECT_THAT(proc_text("/proc/self/stat"), testing::StartsWith(std::to_string(getpid()) + " ("));
}

}  // namespace
}  // namespace handcast::supervisor
