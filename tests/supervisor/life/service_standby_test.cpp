// SPDX-License-Identifier: Apache-2.0
// A service with two processes: a worker and its standby, or its replacement.
#include <sys/resource.h>

#include "tests/supervisor/life/service_fixture.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;

/// own.
class ServiceWithStandby : public ServiceTest {
 protected:
  void SetUp() override {
    ServiceTest::SetUp();
    process_.standby = true;
  }
  Service& ready_service() {
    auto& pose = service(kStandbys);
    pose.start();
    run_until([&] { return pose.state() == State::ready && pose.standby_pid() != 0; });
    return pose;
  }
  static constexpr auto kStandbys =
      "if [ -n \"$HANDCAST_STANDBY_FD\" ]; then\n"
      "  printf s >&$HANDCAST_READY_FD\n"
      "  read -n 1 -u $HANDCAST_STANDBY_FD || exit 0\n"
      "fi\n"
      "echo >&$HANDCAST_READY_FD; exec sleep 1000";
};

TEST_F(ServiceWithStandby, TheStandbyTakesOverWhenTheWorkerDies) {
  auto& pose = ready_service();
  const auto worker = pose.pid(), standby = pose.standby_pid();
  ::kill(worker, SIGKILL);
  run_until([&] { return pose.pid() != worker && pose.state() == State::ready; });
  EXPECT_EQ(pose.pid(), standby);
  EXPECT_EQ(pose.restarts(), 1);
  run_until([&] { return pose.standby_pid() != 0; });
  EXPECT_NE(pose.standby_pid(), standby) << "there is a new one";
}

TEST_F(ServiceWithStandby, AStandbyThatDiesIsReplacedAndDoesNotCount) {
  auto& pose = ready_service();
  const auto worker = pose.pid(), standby = pose.standby_pid();
  ::kill(standby, SIGKILL);
  run_until([&] { return pose.standby_pid() != 0 && pose.standby_pid() != standby; });
  EXPECT_EQ(pose.pid(), worker);
  EXPECT_EQ(pose.restarts(), 0);
  EXPECT_EQ(pose.state(), State::ready);
}

/// While the object exists, the process can open nothing more, and so start nothing.
class NoDescriptorsLeft {
 public:
  NoDescriptorsLeft() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{.rlim_cur = 3, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptorsLeft() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoDescriptorsLeft(const NoDescriptorsLeft&) = delete;

 private:
  rlimit before_{};
};

TEST_F(ServiceWithStandby, BothOfWhichCannotBeStartedAtTheSameMomentAreStartedLater) {
  auto& pose = ready_service();
  {
    const NoDescriptorsLeft none;
    const auto worker = pose.pid();
    ::kill(pose.standby_pid(), SIGKILL);
    run_until([&] { return pose.standby_pid() == 0; });
    ::kill(worker, SIGKILL);
    run_until([&] { return !pose.is_running(); });
    pose.tick(now_ns() + seconds_to_ns(60), look());  // both are due
    EXPECT_FALSE(pose.is_running());
  }
  pose.tick(now_ns() + seconds_to_ns(120), look());
  run_until([&] { return pose.state() == State::ready && pose.standby_pid() != 0; });
}

TEST_F(ServiceWithStandby, AStandbyThatHangsIsReplaced) {
  launch_.silent_s = 0.2;
  auto& pose = ready_service();
  const auto standby =
      pose.standby_pid();  // the script says one 's' and then nothing, as if it were stopped
  run_until([&] { return pose.standby_pid() != 0 && pose.standby_pid() != standby; });
  EXPECT_EQ(pose.restarts(), 0);
}

/// A service without standby whose processes can be prepared, except with the back end "broken".
class ReplacedService : public ServiceWithStandby {
 protected:
  void SetUp() override {
    ServiceWithStandby::SetUp();
    process_.standby = false;
  }
  Service& ready_service() {
    auto& pose = service(
        "case \"$*\" in *pose.backend=broken*) echo '1.0 pose error it is broken' >&2; exit 100;;"
        " esac\n" +
        std::string(kStandbys));
    pose.start();
    run_until([&] { return pose.state() == State::ready; });
    return pose;
  }
  static Settings with_backend(const Service& service, const std::string& backend) {
    auto wanted = service.settings();
    wanted.spec.backend = wanted.swapped = backend;
    wanted.spec.fingerprint = "of " + backend;
    return wanted;
  }
};

TEST_F(ReplacedService, TheOldProcessWorksUntilTheNewOneCanAndTheSettingsChangeWithIt) {
  auto& pose = ready_service();
  const auto before = pose.pid();
  pose.prepare(with_backend(pose, "replay"), {}, false);
  run_until([&] { return pose.replacement_is_prepared(); });
  EXPECT_EQ(pose.pid(), before);
  EXPECT_EQ(pose.state(), State::ready);
  EXPECT_EQ(pose.spec().backend, "twin") << "that is what works";
  EXPECT_EQ(pose.saved().swapped, "") << "and what a successor would continue";
  pose.hand_over();
  EXPECT_EQ(pose.spec().backend, "replay");
  EXPECT_EQ(pose.saved().swapped, "replay");
  EXPECT_EQ(pose.saved().fingerprint, "of replay");
  EXPECT_NE(pose.pid(), before);
  run_until([&] { return pose.state() == State::ready && ::kill(before, 0) != 0; });
  EXPECT_FALSE(pose.has_replacement());
  EXPECT_EQ(pose.restarts(), 0);
  pose.stop();
  run_until([&] { return pose.state() == State::stopped; });
}

TEST_F(ReplacedService, OneThatCannotBePreparedSaysWhyAndTheOldProcessGoesOn) {
  auto& pose = ready_service();
  const auto before = pose.pid();
  pose.prepare(with_backend(pose, "broken"), {}, false);
  run_until([&] { return !pose.has_replacement(); });
  EXPECT_EQ(pose.replacement_problem(), "it is broken");
  EXPECT_EQ(pose.pid(), before);
  EXPECT_EQ(pose.state(), State::ready);
  pose.hand_over();
  EXPECT_EQ(pose.pid(), before) << "there is nothing to hand over to";
  ::kill(before, SIGKILL);
  run_until([&] { return pose.pid() != before && pose.state() == State::ready; });
  EXPECT_EQ(pose.spec().backend, "twin") << "the old settings";
}

TEST_F(ReplacedService, OneThatNeedsTheDeviceGetsItsTurnAfterTheOldProcessHasEnded) {
  auto& pose = ready_service();
  const auto before = pose.pid();
  pose.prepare(with_backend(pose, "replay"), {.alone = true}, false);
  run_until([&] { return pose.replacement_is_prepared(); });
  pose.hand_over();
  EXPECT_EQ(pose.pid(), before);
  EXPECT_EQ(pose.state(), State::stopping);
  run_until([&] { return pose.pid() != before && pose.state() == State::ready; });
  EXPECT_NE(::kill(before, 0), 0);
  EXPECT_EQ(pose.spec().backend, "replay");
}

TEST_F(ReplacedService, AStopInTheMiddleEndsBothAndLeavesTheOldSettings) {
  auto& pose = ready_service();
  pose.prepare(with_backend(pose, "replay"), {}, false);
  run_until([&] { return pose.replacement_is_prepared(); });
  pose.stop();
  run_until([&] { return pose.state() == State::stopped; });
  EXPECT_FALSE(pose.is_running());
  EXPECT_EQ(pose.spec().backend, "twin");
  pose.start();
  run_until([&] { return pose.state() == State::ready; });
  EXPECT_EQ(pose.spec().backend, "twin");
}

TEST_F(ReplacedService, AnAdoptedProcessIsReplacedToo) {
  auto& first = ready_service();
  auto& second = adopting(first, kStandbys, 0);
  const auto adopted = second.pid();
  second.prepare(second.settings(), {}, true);
  run_until([&] { return second.replacement_is_prepared(); });
  second.hand_over();
  run_until([&] { return second.state() == State::ready && second.standby_pid() == 0; });
  EXPECT_NE(second.pid(), adopted);
  second.stop();
  run_until([&] { return second.state() == State::stopped; });
}

TEST_F(ServiceWithStandby, StopEndsBoth) {
  auto& pose = ready_service();
  const auto worker = pose.pid(), standby = pose.standby_pid();
  pose.stop();
  run_until([&] { return pose.state() == State::stopped; });
  EXPECT_NE(::kill(worker, 0), 0);
  EXPECT_NE(::kill(standby, 0), 0);
  EXPECT_FALSE(pose.is_running());
}

TEST_F(ServiceWithStandby, RestartReplacesBoth) {
  auto& pose = ready_service();
  const auto worker = pose.pid(), standby = pose.standby_pid();
  pose.restart();
  run_until([&] {
    return pose.state() == State::ready && pose.pid() != worker && pose.standby_pid() != 0 &&
           pose.standby_pid() != standby;
  });
  EXPECT_NE(pose.pid(), standby) << "a standby of the old settings does not take over";
}

}  // namespace
}  // namespace handcast::supervisor
