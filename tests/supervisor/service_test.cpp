#include "supervisor/service.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <fstream>

#include "ipc/base/clock.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;

/// A service whose program is a shell script of the test.
class ServiceTest : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/handcast-service-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    launch_.program_folder = name;
    launch_.rig_file = "rig.toml";
    launch_.stop_s = 0.2;
    launch_.ready_s = 20;
    timer_ = open_timer(5'000'000).value();
    loop_.watch(timer_.get(), [this] {
      drain(timer_.get());
      for (const auto& service : services_) service->tick(now_ns());
    });
  }
  void TearDown() override {
    services_.clear();
    std::filesystem::remove_all(launch_.program_folder);
  }

  Service& service(const std::string& script) {
    const auto program = launch_.program_folder / "handcast-pose";
    std::ofstream(program) << "#!/bin/bash\n" << script << "\n";
    chmod(program.c_str(), 0755);
    services_.push_back(std::make_unique<Service>(ServiceSpec{.name = "pose", .stream = "pose.hands", .backend = "twin", .asked_hz = 0},
                                                  launch_, loop_, [this](Service&, Service::Event event) { events_.push_back(event); }));
    return *services_.back();
  }
  void run_until(const std::function<bool()>& done) {
    const auto limit = Deadline::in(std::chrono::seconds(30));
    while (!done() && !limit.passed()) loop_.turn();
    ASSERT_TRUE(done());
  }

  EventLoop loop_ = EventLoop::open().value();
  UniqueFd timer_;
  Launch launch_;
  std::vector<std::unique_ptr<Service>> services_;
  std::vector<Service::Event> events_;
};

constexpr auto kWorks = "echo >&$HANDCAST_READY_FD; exec sleep 1000";

TEST_F(ServiceTest, IsReadyWhenItSaysSoAndStopsWhenAsked) {
  auto& pose = service(kWorks);
  pose.start();
  EXPECT_EQ(pose.state(), State::starting);
  run_until([&] { return pose.state() == State::ready; });
  pose.stop();
  run_until([&] { return pose.state() == State::stopped; });
  EXPECT_THAT(events_, ElementsAre(Service::Event::ready, Service::Event::stopped));
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
  auto& pose = service("trap '' TERM; echo >&$HANDCAST_READY_FD; while :; do sleep 0.05; done");
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
  EXPECT_THAT(events_, ElementsAre(Service::Event::failed));
}

TEST_F(ServiceTest, ABackEndOnTrialThatDiesIsNotTriedAgainAndTheOldOneWorksOn) {
  auto& pose = service("case \"$*\" in *pose.backend=broken*) exit 111;; esac\n" + std::string(kWorks));
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

}  // namespace
}  // namespace handcast::supervisor
