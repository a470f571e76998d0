// SPDX-License-Identifier: Apache-2.0
// Both sides of the contract, each at its end of the descriptors.
#include "ipc/daemon/supervision.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <thread>

#include "ipc/daemon/stop_signal.hpp"
#include "ipc/daemon/words.hpp"
#include "tests/ipc/daemon/daemon_environment.hpp"

namespace handcast::daemon {
namespace {

using testing::ExitedWithCode;
using testing::HasSubstr;

/// A pipe whose daemon's end goes into a handover.
struct Pipe {
  Pipe() {
    int ends[2];
    if (pipe(ends) == 0) read = UniqueFd(ends[0]), write = UniqueFd(ends[1]);
  }
  UniqueFd read, write;
};

Supervision supervision_of(const Handover& handover) {
  const DaemonEnvironment environment(handover);
  return Supervision::from_environment("pose");
}

TEST(Supervision, ReadyIsSaidOnceAndThenTheDescriptorIsClosed) {
  Pipe ready;
  auto daemon = supervision_of({.ready_fd = ready.write.release()});
  daemon.tell_ready();
  daemon.tell_ready();
  const auto words = read_words(ready.read.get());
  EXPECT_TRUE(words.any);
  EXPECT_TRUE(words.ready);
  EXPECT_TRUE(read_words(ready.read.get()).closed);
}

TEST(Supervision, AStandbyIsPreparedLongBeforeItIsReady) {
  Pipe ready, turn;
  auto standby =
      supervision_of({.ready_fd = ready.write.release(), .standby_fd = turn.read.release()});
  EXPECT_TRUE(standby.is_standby());
  std::thread waits([&] { standby.await_turn(); });
  const auto prepared = read_words(ready.read.get());
  EXPECT_TRUE(prepared.any);
  EXPECT_FALSE(prepared.ready);
  EXPECT_TRUE(give_turn(turn.write.get()));
  waits.join();
  EXPECT_FALSE(standby.is_standby());
  standby.tell_ready();
  while (!read_words(ready.read.get()).ready) {
  }
}

TEST(Supervision, AStandbyEndsWithZeroWhenItsSupervisorIsGone) {
  Pipe turn;
  turn.write.reset();
  auto standby = supervision_of({.standby_fd = turn.read.release()});
  EXPECT_EXIT(standby.await_turn(), ExitedWithCode(0), "");
}

TEST(Supervision, AStandbyThatIsToldToStopEndsWithZero) {
  Pipe turn;
  auto standby = supervision_of({.standby_fd = turn.read.release()});
  EXPECT_EXIT(
      {
        install_stop_signals();
        raise(SIGTERM);
        standby.await_turn();
      },
      ExitedWithCode(0), "");
}

TEST(Supervision, ADaemonThatIsNoStandbyWaitsForNoTurn) {
  auto daemon = supervision_of({});
  EXPECT_FALSE(daemon.is_standby());
  daemon.await_turn();
}

TEST(Supervision, EachRingIsANewDescriptorOfTheSameFile) {
  const UniqueFd memory(memfd_create("ring", MFD_CLOEXEC));
  ASSERT_EQ(ftruncate(memory.get(), 4096), 0);
  const auto daemon = supervision_of({.rings = {{"pose.hands", memory.get()}}});
  const auto first = daemon.ring("pose.hands"), second = daemon.ring("pose.hands");
  ASSERT_TRUE(first && second);
  EXPECT_NE(first->get(), second->get());
  EXPECT_EQ(lseek(first->get(), 0, SEEK_END), 4096);
  EXPECT_TRUE(fcntl(first->get(), F_GETFD) & FD_CLOEXEC);
}

TEST(Supervision, ARingThatIsNotThereIsNamed) {
  const auto by_hand = supervision_of({}).ring("pose.hands");
  EXPECT_THAT(by_hand.error().what, HasSubstr("`handcast up RIG.toml` starts it"));
  const auto missing = supervision_of({.rings = {{"camera.frames", 5}}}).ring("pose.hands");
  EXPECT_EQ(missing.error().code, Errc::bad_config);
  EXPECT_THAT(missing.error().what, HasSubstr("no ring 'pose.hands' in HANDCAST_RINGS"));
}

TEST(Supervision, ABeatIsDueAHundredMillisecondsAfterTheLast) {
  auto daemon = supervision_of({});
  daemon.note_beat(1'000'000'000);
  EXPECT_FALSE(daemon.beat_is_due(1'099'999'999));
  EXPECT_TRUE(daemon.beat_is_due(1'100'000'000));
}

TEST(Supervision, TheEpochIsTheSupervisors) {
  EXPECT_EQ(supervision_of({.epoch_ns = 42}).epoch_ns(), 42);
  EXPECT_GT(supervision_of({}).epoch_ns(), 42) << "that of this moment";
}

}  // namespace
}  // namespace handcast::daemon
