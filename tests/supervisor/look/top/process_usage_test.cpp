// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/top/process_usage.hpp"

#include <gmock/gmock.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {
namespace {

// utime 700 and stime 50 ticks, nice 5, 9 threads, started at tick 123456, on core 3, priority 50,
// policy SCHED_FIFO.
constexpr std::string_view kStat =
    "4711 (handcast-camera) S 1 4711 4711 0 -1 4194304 103 0 0 0 700 50 0 0 -51 5 9 0 123456 "
    "3133440 418 18446744073709551615 1 2 3 0 0 0 "
    "0 0 0 "
    "0 0 0 17 3 50 1 0 0 0 1 2 3 4 5 6 7 0\n";

TEST(ProcessUsage, IsReadFromTheKernelsText) {
  ProcessUsage usage;
  ASSERT_TRUE(read_stat(kStat, 100, usage));
  EXPECT_EQ(usage.program, "handcast-camera");
  EXPECT_EQ(usage.cpu_ns, 7'500'000'000);
  EXPECT_EQ(usage.started_ticks, 123456u);
  EXPECT_EQ(usage.threads, 9);
  EXPECT_EQ(usage.last_core, 3);
  EXPECT_EQ(usage.priority, 50);
  EXPECT_EQ(usage.policy, SCHED_FIFO);
  EXPECT_EQ(usage.nice, 5);
  ASSERT_TRUE(read_statm("3000 1000 400 5 0 123 0\n", 4096, usage));
  EXPECT_EQ(usage.resident_bytes, 4'096'000);
  EXPECT_EQ(usage.own_bytes(), 600 * 4096);
}

TEST(ProcessUsage, AProcessMayCallItselfWhateverItLikes) {
  std::string text(kStat);
  text.replace(text.find("handcast-camera"), 15, "a) Z 1 2 (b c");
  ProcessUsage usage;
  ASSERT_TRUE(read_stat(text, 100, usage));
  EXPECT_EQ(usage.program, "a) Z 1 2 (b c");
  EXPECT_EQ(usage.threads, 9);
}

TEST(ProcessUsage, TextThatMakesNoSenseIsRefused) {
  ProcessUsage usage;
  for (const auto* text :
       {"", "4711", "4711 (x)", "4711 (x) ", ") (", "4711 (x) S 1 2 3", "4711 x S 1 2 3"})
    EXPECT_FALSE(read_stat(text, 100, usage)) << text;
  for (const auto* text : {"", "12", "a b c"}) EXPECT_FALSE(read_statm(text, 4096, usage)) << text;
}

TEST(ProcessUsage, OneThatOnlyWaitsForItsParentIsNoProcess) {
  const pid_t pid = fork();
  if (pid == 0) _exit(0);
  siginfo_t info{};
  waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOWAIT);
  EXPECT_FALSE(usage_of(pid));
  waitpid(pid, nullptr, 0);
  EXPECT_FALSE(usage_of(pid));
  EXPECT_FALSE(usage_of(0));
}

TEST(ProcessUsage, OfThisProcessIsWhatItDoes) {
  const auto before = usage_of(getpid());
  ASSERT_TRUE(before);
  EXPECT_GT(before->resident_bytes, 0);
  EXPECT_GE(before->threads, 1);
  EXPECT_GE(before->descriptors, 3);
  std::thread busy([until_ns = now_ns() + 100'000'000] {
    while (now_ns() < until_ns)
      ;
  });
  busy.join();
  const auto after = usage_of(getpid());
  ASSERT_TRUE(after);
  const auto cores = cores_used(*before, *after);
  ASSERT_TRUE(cores);
  EXPECT_GT(*cores, 0.01);
}

TEST(ProcessUsage, TheShareIsOfOneCoreAndOfOneProcess) {
  const ProcessUsage before{.taken_ns = 1'000'000'000, .cpu_ns = 5'000'000'000, .started_ticks = 7};
  auto after = before;
  after.taken_ns += 2'000'000'000;
  after.cpu_ns += 3'000'000'000;
  EXPECT_DOUBLE_EQ(cores_used(before, after).value(), 1.5);
  EXPECT_FALSE(cores_used(before, before));
  after.started_ticks = 8;
  EXPECT_FALSE(cores_used(before, after));
}

TEST(ProcessUsage, SchedulingIsSaidWhereItIsNotTheUsual) {
  EXPECT_EQ(scheduling_of({}), "");
  EXPECT_EQ(scheduling_of({.nice = 10}), "nice 10");
  EXPECT_EQ(scheduling_of({.policy = SCHED_FIFO, .priority = 50}), "FIFO 50");
}

}  // namespace
}  // namespace handcast::supervisor
