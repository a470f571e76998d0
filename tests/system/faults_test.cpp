// SPDX-License-Identifier: Apache-2.0
// Faults and changes during which the light must continue.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "services/lab/twin/twin.hpp"
#include "services/recording/arrays/recorded_hands.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::HasSubstr;

class Faults : public SystemTest {
 protected:
  void expect_restarts(const std::map<std::string, int>& restarts) const {
    const auto now = status();
    for (const auto& name : kServices)
      EXPECT_EQ(now["services"][name]["restarts"], restarts.contains(name) ? restarts.at(name) : 0)
          << name;
  }
};

/// A recording of half a second of the twin's left hand.
void record_a_hand(const std::filesystem::path& folder) {
  const auto twin = twin::Twin::create({}, calib::reference_rig());
  ASSERT_TRUE(twin) << twin.error().what;
  recording::RecordedHands recording;
  for (std::uint64_t k = 0; k < 50; ++k) {
    recording.time_ns.push_back(static_cast<std::int64_t>(k) * ms_to_ns(10));
    recording.hands[0].push_back((*twin)->tracker_sample(k).poses.hands[0]);
  }
  ASSERT_TRUE(recording::write_recording(folder, recording));
}

TEST_F(Faults, EachServiceMayBeKilledAndTheLightGoesOn) {
  const auto rig = up();
  wait_until_light();
  std::map<std::string, int> restarts;
  for (const auto& name : kServices) {
    const auto victim = service(name)["pid"].get<pid_t>();
    const auto killed_ns = now_ns();
    ASSERT_EQ(kill(victim, SIGKILL), 0);
    expect_more_light();
    ASSERT_TRUE(eventually([&] {
      const auto now = service(name);
      return now["pid"] != victim && now["state"] == "ready";
    })) << name;
    std::printf("%s was ready again %.0f ms after it was killed\n", name.c_str(),
                ns_to_ms(now_ns() - killed_ns));
    expect_more_light();
    restarts[name] = 1;
    expect_restarts(restarts);  // only this service was restarted
    EXPECT_EQ(service(name)["last_exit"], "signal 9 (Killed)");
  }
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(), 0);
}

TEST_F(Faults, AServiceThatHangsIsReplaced) {
  const auto rig = up();
  wait_until_light();
  const auto victim = service("landmarks")["pid"].get<pid_t>();
  kill(victim, SIGSTOP);
  EXPECT_TRUE(eventually([&] { return !is_alive(victim); }));
  EXPECT_TRUE(eventually([&] { return service("landmarks")["state"] == "ready"; }));
  expect_restarts({{"landmarks", 1}});
}

// The time in the message is that of the supervisor.
TEST_F(Faults, AProjectorThatIsStoppedIsReplacedBeforeSilentSIsOver) {
  const auto rig = up({"--set", "supervisor.silent_s=10"});
  wait_until_light();
  const auto victim = service("projector")["pid"].get<pid_t>();
  kill(victim, SIGSTOP);
  EXPECT_TRUE(eventually([&] { return !is_alive(victim); }));
  EXPECT_TRUE(eventually([&] { return service("projector")["state"] == "ready"; }));
  expect_restarts({{"projector", 1}});
  const auto log = rig->log();
  const std::string begin = "projector has given no sign of life for ";
  const auto found = log.find(begin);
  ASSERT_NE(found, std::string::npos) << log;
  EXPECT_LT(std::stod(log.substr(found + begin.size())), 10);
  EXPECT_THAT(log.substr(found), HasSubstr("s and is stopped; killed"));
  expect_more_light();
}

/// Processes that use all the time that the machine gives them.
class Busy {
 public:
  explicit Busy(int count) {
    for (int i = 0; i < count; ++i) {
      pids_.push_back(fork());
      if (pids_.back() != 0) continue;
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      for (;;) getppid();
    }
  }
  ~Busy() {
    for (const auto pid : pids_) kill(pid, SIGKILL);
    for (const auto pid : pids_) waitpid(pid, nullptr, 0);
  }
  Busy(const Busy&) = delete;

 private:
  std::vector<pid_t> pids_;
};

TEST_F(Faults, ALoadedMachineKillsNobody) {
  const auto rig = up();
  wait_until_light();
  const auto before = pids();
  {
    const Busy busy(64);
    sleep(8);  // four times as long as a service may be silent
  }
  expect_more_light();
  EXPECT_EQ(pids(), before);
  expect_restarts({});
  EXPECT_EQ(rig->log().find("no sign of life"), std::string::npos) << rig->log();
}

TEST_F(Faults, AServiceInAnEndlessLoopIsReplaced) {
  const auto programs = scratch_.path() / "bin";
  std::filesystem::create_directory(programs);
  std::filesystem::copy_file(program_folder() / "handcast", programs / "handcast");
  for (const auto* name : {"camera", "pose", "landmarks", "projector", "content", "desk"})
    std::filesystem::create_symlink(
        std::filesystem::absolute(program_folder()) / ("handcast-" + std::string(name)),
        programs / ("handcast-" + std::string(name)));
  std::filesystem::create_symlink(
      std::filesystem::absolute(program_folder()) / "handcast_looping_observer",
      programs / "handcast-observer");
  const auto loop = scratch_.path() / "loop";
  const Variable there("HANDCAST_BIN", programs.string()), told("HANDCAST_LOOP", loop.string());

  const auto rig = up();
  wait_until_light();
  const auto victim = service("observer")["pid"].get<pid_t>();
  std::ofstream(loop) << "now";
  EXPECT_TRUE(eventually([&] { return !is_alive(victim); }));
  EXPECT_TRUE(eventually([&] { return service("observer")["state"] == "ready"; }));
  expect_restarts({{"observer", 1}});
  EXPECT_THAT(rig->log(), HasSubstr("observer has given no sign of life"));
  expect_more_light();
}

TEST_F(Faults, AMachineThatStoodStillKillsNobody) {
  const auto rig = up();
  wait_until_light();
  auto everybody = pids();
  everybody.insert(everybody.begin(), {rig->pid(), rig->supervisor()});
  for (const auto pid : everybody) kill(pid, SIGSTOP);
  sleep(4);  // twice as long as a service may be silent
  for (const auto pid : everybody) kill(pid, SIGCONT);
  expect_more_light();
  EXPECT_TRUE(eventually([&] { return rig->log().find("stood still") != std::string::npos; }));
  expect_restarts({});
}

TEST_F(Faults, AStandbyProjectorTakesOverAndTheLightGoesOn) {
  const auto rig = up({"--set", "projector.process.standby=true"});
  wait_until_light();
  ASSERT_TRUE(eventually([&] { return service("projector")["standby"].is_number(); }));
  const auto before = service("projector");
  ASSERT_EQ(kill(before["pid"].get<pid_t>(), SIGKILL), 0);
  expect_more_light();
  EXPECT_TRUE(eventually([&] { return service("projector")["state"] == "ready"; }));
  EXPECT_EQ(service("projector")["pid"], before["standby"]);
  expect_restarts({{"projector", 1}});
  EXPECT_TRUE(eventually([&] { return service("projector")["standby"].is_number(); }))
      << "there is a new standby";
  const auto both = service("projector");
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_FALSE(is_alive(both["pid"].get<pid_t>()));
  EXPECT_FALSE(is_alive(both["standby"].get<pid_t>()));
}

TEST_F(Faults, ServicesStartInTheOrderOfTheirNeeds) {
  const auto rig = up();
  wait_until_light();
  const auto log = rig->log();
  const auto ready = [&](const std::string& name) {
    return log.find(" " + name + std::string(11 - name.size(), ' ') + "info    ready");
  };
  for (const auto& name : kServices)
    ASSERT_NE(ready(name), std::string::npos) << name << "\n" << log;
  EXPECT_LT(ready("camera"), ready("landmarks"));
  EXPECT_LT(ready("landmarks"), ready("projector"));
  EXPECT_LT(ready("pose"), ready("projector"));
  EXPECT_LT(ready("projector"), ready("observer"));
}

TEST_F(Faults, APoseSourceIsSwappedForARecordingWhileTheOthersRunOn) {
  const auto folder = scratch_.path() / "recording";
  record_a_hand(folder);
  const auto rig = up({"--set", "pose.replay.directory=" + folder.string()});
  wait_until_light();
  const auto swapped = handcast({"swap", "pose", "replay"});
  EXPECT_EQ(swapped.exit_code, 0) << swapped.log;
  EXPECT_THAT(swapped.output, HasSubstr("pose is ready with 'replay' (the stream paused for "));
  EXPECT_EQ(service("pose")["backend"], "replay");
  expect_restarts({});
  const auto poses = [this] { return status()["rings"]["pose.hands"]["count"].get<int>(); };
  const auto before = poses();
  EXPECT_TRUE(eventually([&] { return poses() > before; }));
  expect_more_light();
}

TEST_F(Faults, ASwapThatCannotWorkChangesNothing) {
  const auto rig = up();
  wait_until_light();
  const auto unknown = handcast({"swap", "pose", "crystal_ball"});
  EXPECT_EQ(unknown.exit_code, 100);
  EXPECT_THAT(unknown.log, HasSubstr("no back end 'crystal_ball'; it has: twin, replay"));
  expect_restarts({});

  const auto before = service("pose")["pid"];
  const auto without_folder = handcast({"swap", "pose", "replay"});
  EXPECT_EQ(without_folder.exit_code, 100);
  EXPECT_THAT(without_folder.log, HasSubstr("pose.replay.directory"));
  EXPECT_THAT(without_folder.log, HasSubstr("'twin' goes on"));
  EXPECT_EQ(service("pose")["pid"], before) << "it was never stopped";
  EXPECT_EQ(service("pose")["backend"], "twin");
  EXPECT_EQ(service("pose")["state"], "ready");
  EXPECT_THAT(handcast({"swap", "moon", "twin"}).log, HasSubstr("no service 'moon'"));
  expect_more_light();
}

}  // namespace
}  // namespace handcast::system_test
