// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/adoption.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "ipc/base/clock.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/ring_view.hpp"
#include "ipc/ring/writer.hpp"
#include "supervisor/base/event_loop.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/life/child.hpp"
#include "tests/supervisor/scope_scratch.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr int kRingFd = 200;  ///< its number in the services; free in this process

std::uint64_t inode_of(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 ? status.st_ino : 0;
}

/// A ring and a service that inherited it, as they are after the death of their supervisor.
class AdoptionTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = ipc::Segment::create(ipc::RingSpec::of<msg::StageMarks>("marks.pose", 8, true));
    ASSERT_TRUE(made);
    inode_ = inode_of(made->fd());
    auto writer = ipc::Writer<msg::StageMarks>::attach(std::move(*made));
    ASSERT_TRUE(writer);
    msg::StageMarks marks;
    marks.header.frame_id = 7;
    writer->publish(marks);
    writer_.emplace(std::move(*writer));
    saved_.name = "desk";
    saved_.epoch_ns = 42;
    saved_.rings = {{"marks.pose", inode_, kRingFd}};
    leave_ring();
  }
  void TearDown() override { close(kRingFd); }

  /// The ring under its number; the supervisor's death closes it: close(kRingFd).
  void leave_ring() {
    const auto folder = std::filesystem::directory_iterator("/proc/self/fd");
    for (const auto& entry : folder)
      if (inode_of(std::stoi(entry.path().filename())) == inode_) {
        dup2(std::stoi(entry.path().filename()), kRingFd);
        return;
      }
    FAIL() << "the ring is not open";
  }

  Child& service(const std::string& name, const std::string& script, bool ready = true) {
    auto child = Child::spawn({.program = "/bin/bash",
                               .arguments = {"-c", script},
                               .rings = {{"marks.pose", kRingFd}},
                               .rig = control::address_of("desk").value().text,
                               .state_fd = state_.fd()});
    EXPECT_TRUE(child);
    children_.push_back(std::make_unique<Child>(std::move(*child)));
    const auto pid = children_.back()->pid();
    saved_.services.push_back({name, pid, start_ticks_of(pid).value_or(0),
                               ready ? State::ready : State::starting, "", "f", 2});
    return *children_.back();
  }

  Result<std::optional<AdoptedRig>> adopt_after_death() {
    EXPECT_TRUE(state_.save(saved_));
    close(kRingFd);
    return adopt("desk");
  }

  ScopeScratch scratch_;
  std::uint64_t inode_ = 0;
  std::optional<ipc::Writer<msg::StageMarks>> writer_;
  SavedRig saved_;
  StateMemory state_ = StateMemory::create().value();
  std::vector<std::unique_ptr<Child>> children_;
};

TEST_F(AdoptionTest, ALivingServiceAndItsRingAreTakenOver) {
  const auto& pose = service("pose", "exec sleep 1000");
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted) << adopted.error().what;
  ASSERT_TRUE(*adopted);
  const auto& rig = **adopted;
  EXPECT_EQ(rig.saved.epoch_ns, 42);
  ASSERT_THAT(rig.services, SizeIs(1));
  EXPECT_EQ(rig.services[0].saved.pid, pose.pid());
  EXPECT_EQ(rig.services[0].saved.restarts, 2);
  ASSERT_THAT(rig.rings, SizeIs(1));
  EXPECT_EQ(rig.rings[0].fd(), kRingFd);
  EXPECT_EQ(inode_of(rig.rings[0].fd()), inode_);
  EXPECT_EQ(fcntl(kRingFd, F_GETFD), FD_CLOEXEC);
  EXPECT_NE(fcntl(kRingFd, F_GETFL) & O_RDWR, 0);

  auto reader =
      ipc::Reader<msg::StageMarks>::attach(ipc::Segment::open(UniqueFd(dup(kRingFd))).value());
  ASSERT_TRUE(reader);
  EXPECT_EQ((*reader->latest(Deadline::now()))->header.frame_id, 7u);
}

TEST_F(AdoptionTest, WhatTheServiceSaysIsHeardAgain) {
  const auto& pose =
      service("pose", "trap 'echo hello' USR1; echo up; while :; do sleep 0.02; done");
  pollfd up{.fd = pose.log_fd(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(poll(&up, 1, 20000), 1);
  drain(pose.log_fd());
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  const auto& log = (*adopted)->services.at(0).log;
  char text[64] = {};
  EXPECT_LT(read(log.get(), text, sizeof text), 0);  // does not block
  kill(pose.pid(), SIGUSR1);
  pollfd heard{.fd = log.get(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(poll(&heard, 1, 20000), 1);
  ASSERT_GT(read(log.get(), text, sizeof text - 1), 0);
  EXPECT_THAT(text, HasSubstr("hello"));
}

TEST_F(AdoptionTest, WhoDiedMeanwhileIsLeftToBeStarted) {
  service("pose", "exec sleep 1000");
  auto& camera = service("camera", "exec sleep 1000");
  camera.signal(SIGKILL);
  pollfd ended{.fd = camera.pidfd(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(poll(&ended, 1, 20000), 1);  // a zombie, which still has its number
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  ASSERT_THAT((*adopted)->services, SizeIs(1));
  EXPECT_EQ((*adopted)->services[0].saved.name, "pose");
}

TEST_F(AdoptionTest, AProcessThatHasTheNumberByNowIsNotTouched) {
  service("pose", "exec sleep 1000");
  auto stranger = Child::spawn({.program = "/bin/bash", .arguments = {"-c", "exec sleep 1000"}});
  ASSERT_TRUE(stranger);
  const auto ticks = start_ticks_of(stranger->pid()).value_or(0);
  saved_.services.push_back({"camera", stranger->pid(), ticks, State::ready, "", "f", 0});
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  EXPECT_THAT((*adopted)->services, SizeIs(1));
  usleep(50'000);
  EXPECT_EQ(stranger->try_reap(), std::nullopt);
}

TEST_F(AdoptionTest, AnotherServiceThatHasTheNumberByNowIsKilledNotAdopted) {
  service("pose", "exec sleep 1000");
  auto& other = service("camera", "exec sleep 1000");
  saved_.services.back().started_ticks -= 1;
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  EXPECT_THAT((*adopted)->services, SizeIs(1));
  EXPECT_EQ(other.try_reap()->code, SIGKILL);
}

TEST_F(AdoptionTest, OneThatWasStartedAfterTheStateWasSavedIsKilled) {
  service("pose", "exec sleep 1000");
  auto& late = service("camera", "exec sleep 1000");
  saved_.services.pop_back();
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  EXPECT_THAT((*adopted)->services, SizeIs(1));
  EXPECT_EQ(late.try_reap()->code, SIGKILL);
}

TEST_F(AdoptionTest, WithoutAStateThatCanBeReadTheServicesAreKilledAndTheRigStartsAnew) {
  auto& pose = service("pose", "exec sleep 1000");
  saved_.name = "sofa";
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted) << adopted.error().what;
  EXPECT_FALSE(*adopted);
  EXPECT_EQ(pose.try_reap()->code, SIGKILL);
}

TEST_F(AdoptionTest, AnotherFileUnderTheRingsNumberIsNotTakenForTheRing) {
  service("pose", "exec sleep 1000");
  saved_.rings[0].inode += 1;
  const auto adopted = adopt_after_death();
  ASSERT_FALSE(adopted);
  EXPECT_EQ(adopted.error().code, Errc::unavailable);
  EXPECT_THAT(adopted.error().what, HasSubstr("ring 'marks.pose'"));
  EXPECT_THAT(adopted.error().what, HasSubstr("another file"));
  EXPECT_THAT(adopted.error().what, HasSubstr("`handcast down --rig desk`"));
}

TEST_F(AdoptionTest, ANumberThatIsTakenHereIsAnErrorAndTheTakerKeepsIt) {
  service("pose", "exec sleep 1000");
  ASSERT_TRUE(state_.save(saved_));
  const UniqueFd other(memfd_create("other", MFD_CLOEXEC));
  dup2(other.get(), kRingFd);
  const auto adopted = adopt("desk");
  ASSERT_FALSE(adopted);
  EXPECT_THAT(adopted.error().what, HasSubstr("descriptor 200"));
  EXPECT_EQ(inode_of(kRingFd), inode_of(other.get()));
}

TEST_F(AdoptionTest, OneThatWasJustStartingIsEndedToBeStartedAnew) {
  service("pose", "exec sleep 1000");
  auto& camera = service("camera", "exec sleep 1000", false);
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  ASSERT_THAT((*adopted)->services, SizeIs(1));
  EXPECT_EQ((*adopted)->services[0].saved.name, "pose");
  EXPECT_TRUE(camera.try_reap());
}

TEST_F(AdoptionTest, ReadersThatDiedGiveTheirRowsBack) {
  service("pose", "exec sleep 1000");
  const pid_t reader = fork();
  if (reader == 0) {
    const auto attached =
        ipc::Reader<msg::StageMarks>::attach(ipc::Segment::open(UniqueFd(dup(kRingFd))).value());
    _exit(attached ? 0 : 1);  // without releasing its row
  }
  int status = -1;
  waitpid(reader, &status, 0);
  ASSERT_EQ(status, 0);
  ASSERT_THAT(ipc::RingView::open(UniqueFd(dup(kRingFd))).value().look().readers, SizeIs(1));
  const auto adopted = adopt_after_death();
  ASSERT_TRUE(adopted && *adopted);
  EXPECT_THAT(ipc::RingView::open(UniqueFd(dup(kRingFd))).value().look().readers, IsEmpty());
}

TEST_F(AdoptionTest, WhereNothingLivesNothingIsAdopted) {
  EXPECT_FALSE(adopt("desk").value());
  EXPECT_FALSE(adopt_after_death().value());
  EXPECT_THAT(orphaned_rigs(), IsEmpty());
}

TEST_F(AdoptionTest, OrphansAreListedWithTheirState) {
  service("pose", "exec sleep 1000");
  ASSERT_TRUE(state_.save(saved_));
  EXPECT_THAT(orphaned_rigs(), ElementsAre("desk"));
  EXPECT_EQ(state_of("desk").value().epoch_ns, 42);
  EXPECT_FALSE(state_of("sofa"));
}

// Runs in another process, because systemd passes descriptors from number 3 on.
TEST_F(AdoptionTest, RingsThatSystemdKeptComeBackWhenNoServiceLives) {
  ASSERT_TRUE(state_.save(saved_));
  const pid_t child = fork();
  if (child == 0) {
    const int state_fd = fcntl(state_.fd(), F_DUPFD, 300);
    dup2(kRingFd, 3);
    dup2(state_fd, 4);
    close(kRingFd);
    setenv("LISTEN_PID", std::to_string(getpid()).c_str(), 1);
    setenv("LISTEN_FDS", "2", 1);
    setenv("LISTEN_FDNAMES", "marks.pose:supervisor.state", 1);
    const auto adopted = adopt("desk");
    const bool right = adopted && *adopted && (*adopted)->services.empty() &&
                       (*adopted)->rings.size() == 1 && (*adopted)->rings[0].fd() == kRingFd &&
                       inode_of(kRingFd) == inode_;
    _exit(right ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace handcast::supervisor
