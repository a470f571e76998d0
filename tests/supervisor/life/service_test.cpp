// SPDX-License-Identifier: Apache-2.0
// The processes of a service over their lives.
#include <gmock/gmock.h>
#include <sys/mman.h>

#include "ipc/msg/hand_poses.hpp"
#include "ipc/ring/writer.hpp"
#include "supervisor/base/process.hpp"
#include "tests/supervisor/life/service_fixture.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;

TEST_F(ServiceTest, IsReadyWhenItSaysSoAndStopsWhenAsked) {
  auto& pose = service(kWorks);
  pose.start();
  EXPECT_EQ(pose.state(), State::starting);
  run_until([&] { return pose.state() == State::ready; });
  pose.stop();
  run_until([&] { return pose.state() == State::stopped; });
  EXPECT_THAT(notices_, ElementsAre(Notice::ready, Notice::stopped));
  EXPECT_EQ(pose.restarts(), 0);
  EXPECT_EQ(pose.pid(), 0);
}

TEST_F(ServiceTest, AKilledServiceComesBackAsAnotherProcess) {
  auto& pose = service(kWorks);
  pose.start();
  run_until([&] { return pose.state() == State::ready; });
  const auto first = pose.pid();
  ::kill(first, SIGKILL);
  run_until([&] { return pose.pid() != first && pose.state() == State::ready; });
  EXPECT_EQ(pose.restarts(), 1);
  EXPECT_EQ(pose.last_exit()->describe(), "signal 9 (Killed)");
}

TEST_F(ServiceTest, OneThatNeverGetsReadyIsReplaced) {
  launch_.ready_s = 0.1;
  auto& pose = service("exec sleep 1000");
  pose.start();
  run_until([&] { return pose.restarts() > 0; });
}

TEST_F(ServiceTest, OneThatDoesNotListenIsKilled) {
  auto& pose = service("trap '' TERM INT; echo >&$HANDCAST_READY_FD; while :; do sleep 0.05; done");
  pose.start();
  run_until([&] { return pose.state() == State::ready; });
  pose.stop();
  run_until([&] { return pose.state() == State::stopped; });
  EXPECT_EQ(pose.last_exit()->code, SIGKILL);
}

TEST_F(ServiceTest, ExitHundredIsFinalAndItsLastWordsAreKept) {
  auto& pose = service("echo '1.0 pose error the folder is empty' >&2; exit 100");
  pose.start();
  run_until([&] { return pose.state() == State::failed; });
  EXPECT_EQ(pose.log().last_sentence(), "the folder is empty");
  EXPECT_EQ(pose.restarts(), 0);
  EXPECT_THAT(notices_, ElementsAre(Notice::failed));
}

TEST_F(ServiceTest, ABackEndOnTrialThatDiesIsNotTriedAgainAndTheOldOneWorksOn) {
  auto& pose =
      service("case \"$*\" in *pose.backend=broken*) exit 111;; esac\n" + std::string(kWorks));
  pose.start();
  run_until([&] { return pose.state() == State::ready; });
  pose.use_backend("broken", true);
  run_until([&] { return pose.state() == State::failed; });
  pose.use_backend("twin", false);
  run_until([&] { return pose.state() == State::ready; });
  EXPECT_EQ(pose.spec().backend, "twin");
}

TEST_F(ServiceTest, AMissingProgramFailsAtOnce) {
  auto& pose = service(kWorks);
  std::filesystem::remove(launch_.program_folder / "handcast-pose");
  pose.start();
  EXPECT_EQ(pose.state(), State::failed);
}

TEST_F(ServiceTest, AStandstillOfTheSupervisorIsHeldAgainstNobody) {
  auto& pose = service("exec sleep 1000");
  pose.start();
  pose.forgive(seconds_to_ns(30));
  pose.tick(now_ns() + seconds_to_ns(45), {});
  EXPECT_FALSE(pose.last_exit());
  pose.tick(now_ns() + seconds_to_ns(55), {});
  run_until([&] { return pose.restarts() > 0; });
}

// The watchdog is wired: with the time of the tick and the settings of the rig.
TEST_F(ServiceTest, OneWhoseHeartStopsIsKilledAfterTwoSecondsNotEarlierAndReplaced) {
  launch_.silent_s = 2;
  auto& pose = service(kWorks);
  pose.start();
  run_until([&] { return pose.state() == State::ready; });
  const auto last_sign_ns = now_ns() + seconds_to_ns(100);
  pose.tick(last_sign_ns + seconds_to_ns(1.99), {.last_sign_ns = last_sign_ns});
  EXPECT_EQ(pose.state(), State::ready);
  pose.tick(last_sign_ns + seconds_to_ns(2.01), {.last_sign_ns = last_sign_ns});
  EXPECT_EQ(pose.state(), State::starting) << "killed";
  run_until([&] { return pose.restarts() == 1 && pose.state() == State::ready; });
  EXPECT_EQ(pose.last_exit()->code, SIGKILL);
}

TEST_F(ServiceTest, OneThatDoesNotListenIsKilledWhenItsTimeIsOverAndNotEarlier) {
  launch_.stop_s = 3000;
  auto& pose = service("trap '' TERM INT; echo >&$HANDCAST_READY_FD; while :; do sleep 0.05; done");
  pose.start();
  run_until([&] { return pose.state() == State::ready; });
  const auto asked_ns = now_ns();
  pose.stop();
  pose.tick(asked_ns + seconds_to_ns(2999), {});
  EXPECT_EQ(pose.state(), State::stopping);
  pose.tick(asked_ns + seconds_to_ns(3001), {});
  run_until([&] { return pose.state() == State::stopped; });
  EXPECT_EQ(pose.last_exit()->code, SIGKILL);
}

TEST_F(ServiceTest, TheSecondDeathWaitsFiftyMillisecondsAndAQuarterAtMost) {
  auto& pose = service("exit 111");
  pose.start();
  run_until([&] { return pose.retry_s(now_ns()).has_value(); });
  EXPECT_EQ(pose.restarts(), 1) << "the first restart came at once";
  EXPECT_LE(*pose.retry_s(now_ns()), 0.0625);
}

TEST_F(ServiceTest, WhatASuccessorNeedsToKnowIsSaved) {
  auto& pose = service(kWorks);
  const auto before = pose.revision();
  EXPECT_EQ(pose.saved().pid, 0);
  pose.start();
  EXPECT_GT(pose.revision(), before);
  run_until([&] { return pose.state() == State::ready; });
  const auto saved = pose.saved();
  EXPECT_EQ(saved.name, "pose");
  EXPECT_EQ(saved.pid, pose.pid());
  EXPECT_EQ(saved.started_ticks, start_ticks_of(pose.pid()).value());
  EXPECT_EQ(saved.state, State::ready);
  EXPECT_EQ(saved.swapped, "") << "its back end is the rig's own";
}

TEST_F(ServiceTest, AnAdoptedServiceGoesOnAsItWasAndIsReplacedWhenItDies) {
  auto& first = service(kWorks);
  first.start();
  run_until([&] { return first.state() == State::ready; });
  auto& second = adopting(first, kWorks, 3);
  EXPECT_EQ(second.state(), State::ready);
  EXPECT_EQ(second.pid(), first.pid());
  EXPECT_EQ(second.restarts(), 3);
  const auto adopted = second.pid();
  ::kill(adopted, SIGKILL);
  run_until([&] { return second.state() == State::ready && second.pid() != adopted; });
  EXPECT_EQ(second.restarts(), 4);
}

TEST_F(ServiceTest, OnlyASwapIsInheritedAsASwap) {
  auto& first = service(kWorks);
  first.use_backend("replay", true);
  EXPECT_EQ(first.saved().swapped, "replay");
  auto saved = first.saved();
  auto& second = service(kWorks);
  second.inherit(saved);
  EXPECT_EQ(second.spec().backend, "replay");
  saved.swapped.clear();
  auto& third = service(kWorks);
  third.inherit(saved);
  EXPECT_EQ(third.spec().backend, "twin");
}

TEST_F(ServiceTest, OneThatHadFailedStaysFailedUnderTheNextSupervisor) {
  auto& pose = service(kWorks);
  pose.inherit({.name = "pose",
                .state = State::failed,
                .swapped = {},
                .fingerprint = "as it was",
                .restarts = 2});
  EXPECT_EQ(pose.state(), State::failed);
  EXPECT_TRUE(pose.first_start_ns()) << "it is not to be begun";
  EXPECT_EQ(pose.restarts(), 2);
  EXPECT_EQ(pose.saved().fingerprint, "as it was");
}

/// A service with the ring it publishes. The test publishes in its place.
class PublishingService : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    launch_.rings = {{"pose.hands", ring_.fd()}};
  }
  /// As a writer that comes anew.
  void publish() {
    auto again = ipc::Segment::open(UniqueFd(dup(ring_.fd()))).value();
    ipc::Writer<msg::HandPoses>::attach(std::move(again)).value().publish({});
  }
  void run_until_said(const Service& service) {
    run_until([&] { return service.log().last_sentence() == "said"; });
    const auto then = ticks_;
    run_until([&] { return ticks_ > then + 1; });
  }

  ipc::Segment ring_ =
      ipc::Segment::create(ipc::RingSpec::of<msg::HandPoses>("pose.hands", 8, true)).value();
  static constexpr auto kSays = "echo >&$HANDCAST_READY_FD; echo said; exec sleep 1000";
};

TEST_F(PublishingService, IsReadyWithItsFirstMessageAndNotBefore) {
  publish();  // of an earlier life
  auto& pose = service(kSays);
  pose.start();
  run_until_said(pose);
  EXPECT_EQ(pose.state(), State::starting);
  publish();
  run_until([&] { return pose.state() == State::ready; });
}

TEST_F(PublishingService, IsReplacedWhenNoMessageComes) {
  launch_.ready_s = 0.2;
  auto& pose = service(kSays);
  pose.start();
  run_until([&] { return pose.restarts() > 0; });
  EXPECT_EQ(pose.last_exit()->code, SIGKILL);
}

TEST_F(PublishingService, MayBeSilentAsLongAsItsNeedsAreNotReady) {
  needs_are_ready_ = false;
  auto& pose = service(kSays);
  pose.start();
  run_until_said(pose);
  launch_.ready_s = 0.05;
  const auto then = ticks_;
  run_until([&] { return ticks_ > then + 40; });
  EXPECT_EQ(pose.restarts(), 0);
  needs_are_ready_ = true;
  run_until([&] { return pose.restarts() > 0; });
}

/// A service with a standby. Each process that has prepared itself leaves its number in a file of
/// its

}  // namespace
}  // namespace handcast::supervisor
