// SPDX-License-Identifier: Apache-2.0
// The times of the rig file where they are wired: a service of a rig on a clock of the test's own.
// Its processes are real and do nothing; what they seem to do is the test's own, too.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/daemon/contract.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/writer.hpp"
#include "supervisor/rig/live_rig.hpp"
#include "tests/scratch.hpp"

namespace handcast::supervisor {
namespace {

config::Rig timed_desk() {
  config::Rig rig;
  rig.name = "desk";
  rig.supervisor.silent_s = 2;
  return rig;
}

class Timing : public testing::Test {
 protected:
  void SetUp() override {
    rig_.launch.program_folder = scratch_.path();
    rig_.launch.now = [this] { return clock_ns_; };
    rig_.launch.look_at = [this](pid_t) { return look(); };
    ASSERT_TRUE(rig_.make_rings({kPose}));
  }

  /// What the process seems to be at each look.
  ProcessLook look() {
    if (seems_ == Activity::busy) ++slices_;
    return {.threads = 1,
            .all_stopped = seems_ == Activity::stopped,
            .all_asleep = seems_ == Activity::asleep,
            .progress = slices_,
            .worked_ns = has_processor_ ? clock_ns_ : 0,
            .waited_ns = has_processor_ ? 0 : clock_ns_};
  }
  Service& service(const std::string& script) {
    const auto program = scratch_.path() / "handcast-pose";
    std::ofstream(program) << "#!/bin/sh\n" << script << "\n";
    chmod(program.c_str(), 0755);
    auto& pose = rig_.services.add(kPose);
    pose.start();
    return pose;
  }
  /// Works off events, but lets no time pass.
  void run_until(const std::function<bool()>& done) {
    const auto limit = Deadline::in(std::chrono::seconds(30));
    auto timer = open_timer(5'000'000).value();
    loop_.watch(timer.get(), [&] { drain(timer.get()); });
    while (!done() && !limit.passed()) loop_.turn();
    loop_.forget(timer.get());
    ASSERT_TRUE(done());
  }
  void beat() {
    const auto fd = daemon::find_ring(rig_.launch.rings, daemon::marks_stream_of("pose"));
    auto segment = ipc::Segment::open(UniqueFd(dup(fd.value()))).value();
    ipc::Writer<msg::StageMarks>::attach(std::move(segment)).value().publish({});
    rig_.recorder.poll();
    clock_ns_ = now_ns();
  }
  /// Ticks until `time_ns`, at most 50 ms apart, as the rig does.
  void tick_until(Service& pose, std::int64_t time_ns) {
    for (; clock_ns_ < time_ns; clock_ns_ = std::min(clock_ns_ + ms_to_ns(50), time_ns))
      pose.tick(clock_ns_, rig_.look_at(pose, clock_ns_));
    pose.tick(clock_ns_, rig_.look_at(pose, clock_ns_));
  }
  /// How long after a heartbeat the rig kills a worker that then seems to do this.
  double killed_after_s(Activity activity) {
    seems_ = activity;
    auto& pose = service("echo >&$HANDCAST_READY_FD; exec sleep 1000");
    run_until([&] { return pose.state() == State::ready; });
    beat();
    const auto beat_ns = clock_ns_ - ms_to_ns(*rig_.recorder.silence_ms("pose", clock_ns_));
    while (pose.state() == State::ready && clock_ns_ < beat_ns + seconds_to_ns(60))
      tick_until(pose, clock_ns_ + ms_to_ns(10));
    return ns_to_seconds(clock_ns_ - beat_ns);
  }

  const ServiceSpec kPose{.name = "pose"};
  test::Scratch scratch_;
  std::int64_t clock_ns_ = now_ns();
  Activity seems_ = Activity::busy;
  std::uint64_t slices_ = 1;
  bool has_processor_ = true;
  EventLoop loop_ = EventLoop::open().value();
  LiveRig rig_{timed_desk(), loop_, [](Service&, Notice) {}};
};

constexpr double kStep_s = 0.011;  // of the ticks

TEST_F(Timing, ASilentWorkerIsKilledAfterSilentS) {
  EXPECT_NEAR(killed_after_s(Activity::busy), 2, kStep_s);
}

TEST_F(Timing, TimeWithoutAProcessorDoesNotCountUntilReadyS) {
  has_processor_ = false;
  EXPECT_NEAR(killed_after_s(Activity::busy), 10, kStep_s);
}

TEST_F(Timing, AStoppedWorkerIsKilledAfterAQuarterOfSilentS) {
  EXPECT_NEAR(killed_after_s(Activity::stopped), 0.5, kStep_s);
}

TEST_F(Timing, AWorkerThatSleepsIsKilledAfterHalfOfSilentS) {
  EXPECT_NEAR(killed_after_s(Activity::asleep), 1, kStep_s);
}

/// The time of the deaths, with the last digits that make the jitter none or the most.
std::int64_t with_digits(std::int64_t time_ns, std::int64_t digits) {
  return time_ns - time_ns % 1009 + 1009 + digits;
}

TEST_F(Timing, TheSecondRestartWaitsFiftyMillisecondsAndTheThirdAHundred) {
  clock_ns_ = with_digits(clock_ns_, 0);
  auto& pose = service("exit 111");
  run_until([&] { return pose.retry_s(clock_ns_).has_value(); });
  EXPECT_EQ(pose.restarts(), 1) << "the first came at once";
  for (const double wait_ms : {50, 100, 200}) {
    const auto died_ns = clock_ns_;
    const auto restarts = pose.restarts();
    tick_until(pose, died_ns + ms_to_ns(wait_ms) - 1);
    EXPECT_EQ(pose.restarts(), restarts) << wait_ms;
    tick_until(pose, died_ns + ms_to_ns(wait_ms));
    EXPECT_EQ(pose.restarts(), restarts + 1) << wait_ms;
    clock_ns_ = with_digits(clock_ns_, 0);
    run_until([&] { return pose.retry_s(clock_ns_).has_value(); });
  }
}

TEST_F(Timing, JitterMakesAWaitUpToAQuarterLonger) {
  clock_ns_ = with_digits(clock_ns_, 1008);
  auto& pose = service("exit 111");
  run_until([&] { return pose.retry_s(clock_ns_).has_value(); });
  const auto died_ns = clock_ns_;
  tick_until(pose, died_ns + ms_to_ns(62.5) - 1);
  EXPECT_EQ(pose.restarts(), 1);
  tick_until(pose, died_ns + ms_to_ns(62.5));
  EXPECT_EQ(pose.restarts(), 2);
}

}  // namespace
}  // namespace handcast::supervisor
