// SPDX-License-Identifier: Apache-2.0
#include "supervisor/life/process_activity.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {
namespace {

/// A child that runs `body`; killed with the object.
class Other {
 public:
  explicit Other(const std::function<void()>& body) : pid_(fork()) {
    if (pid_ != 0) return;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    body();
    _exit(0);
  }
  ~Other() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Other(const Other&) = delete;
  pid_t pid() const { return pid_; }

  /// Waits until two looks find this activity.
  bool comes_to(Activity activity) const {
    for (const auto limit = Deadline::in(std::chrono::seconds(30)); !limit.passed();) {
      const auto before = look_at_process(pid_);
      usleep(50'000);
      if (activity_between(before, look_at_process(pid_)) == activity) return true;
    }
    return false;
  }

 private:
  pid_t pid_;
};

[[noreturn]] void work() {
  for (;;) getppid();
}

TEST(ProcessActivity, AProcessThatSleepsIsAsleepAndOneThatIsStoppedIsStopped) {
  const Other sleeper([] { pause(); });
  if (look_at_process(getpid())->progress == 0)
    GTEST_SKIP() << "this system has no /proc/PID/schedstat";
  EXPECT_TRUE(sleeper.comes_to(Activity::asleep));
  kill(sleeper.pid(), SIGSTOP);
  EXPECT_TRUE(sleeper.comes_to(Activity::stopped));
  kill(sleeper.pid(), SIGCONT);
  EXPECT_TRUE(sleeper.comes_to(Activity::asleep));
}

TEST(ProcessActivity, AProcessIsBusyIfOneOfItsThreadsWorksOrWakesUp) {
  const Other worker([] { work(); });
  EXPECT_TRUE(worker.comes_to(Activity::busy));
  const Other threads([] {
    std::thread(work).detach();
    pause();
  });
  EXPECT_TRUE(threads.comes_to(Activity::busy));
  const Other waker([] {
    for (;;) usleep(10'000);
  });
  if (look_at_process(getpid())->progress == 0)
    GTEST_SKIP() << "this system has no /proc/PID/schedstat";
  EXPECT_TRUE(waker.comes_to(Activity::busy));
}

TEST(ProcessActivity, WithoutTwoLooksOrWithoutCountersNothingIsKnown) {
  const ProcessLook sleeps{.threads = 1, .all_asleep = true, .progress = 7};
  const ProcessLook uncounted{.threads = 1, .all_asleep = true};
  EXPECT_EQ(activity_between({}, sleeps), Activity::unknown);
  EXPECT_EQ(activity_between(sleeps, {}), Activity::unknown);
  EXPECT_EQ(activity_between(uncounted, uncounted), Activity::unknown);
  EXPECT_EQ(activity_between(sleeps, sleeps), Activity::asleep);
  EXPECT_FALSE(look_at_process(-1));
}

TEST(ProcessActivity, OneThatWaitedForAProcessorOrForTheDiskIsNotAsleep) {
  const ProcessLook before{.threads = 2, .all_asleep = true, .progress = 7};
  auto later = before;
  later.progress = 8;
  EXPECT_EQ(activity_between(before, later), Activity::busy);
  later = before;
  later.all_asleep = false;
  EXPECT_EQ(activity_between(before, later), Activity::busy);
  later = before;
  later.threads = 1;
  EXPECT_EQ(activity_between(before, later), Activity::busy);
}

TEST(ProcessActivity, WaitingForAProcessorOrForTheDiskHoldsAProcessUp) {
  const ProcessLook before{.threads = 1, .progress = 7, .worked_ns = 100, .waited_ns = 40};
  auto later = before;
  later.progress = 8;
  EXPECT_EQ(held_up_ns(before, later, 50), 0) << "it woke up, and slept again";
  later.worked_ns = 120;
  later.waited_ns = 65;
  EXPECT_EQ(held_up_ns(before, later, 50), 25);
  later.on_disk = true;
  EXPECT_EQ(held_up_ns(before, later, 50), 30) << "all the time in which it did not work";
  later.worked_ns = 190;
  EXPECT_EQ(held_up_ns(before, later, 50), 0) << "two threads worked";
  EXPECT_EQ(held_up_ns({}, later, 50), 0);
}

}  // namespace
}  // namespace handcast::supervisor
