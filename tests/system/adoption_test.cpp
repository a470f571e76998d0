// SPDX-License-Identifier: Apache-2.0
// The supervisor is killed: services and light continue, and the next supervisor takes them over.
#include "supervisor/succession/adoption.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <fstream>

#include "ipc/control/rig_address.hpp"
#include "ipc/ring/ring_view.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;

class Adoption : public SystemTest {
 protected:
  /// The memory in which the supervisor saves its state, and that state.
  /// @{
  supervisor::StateMemory memory() const {
    const Variable scope(control::kScopeVariable, scratch_.path().string());
    return supervisor::state_memory_of(supervisor::find_services("twin").at(0)).value();
  }
  supervisor::SavedRig state() const { return memory().load("twin").value(); }
  /// @}

  /// A view of the ring through the descriptor of a service, which needs no supervisor.
  ipc::RingView view(const std::string& stream) const {
    const auto saved = state();
    const auto ring = std::ranges::find(saved.rings, stream, &supervisor::SavedRing::stream);
    const auto file =
        "/proc/" + std::to_string(saved.services[0].pid) + "/fd/" + std::to_string(ring->fd);
    return ipc::RingView::open(UniqueFd(open(file.c_str(), O_RDWR | O_CLOEXEC))).value();
  }

  /// Kills the supervisor and waits until another one, started by the keeper, answers.
  void replace_supervisor(const Command& rig) const {
    const auto before = rig.supervisor();
    ASSERT_GT(before, 0);
    ASSERT_EQ(kill(before, SIGKILL), 0);
    ASSERT_TRUE(eventually(
        [&] { return rig.supervisor() > 0 && rig.supervisor() != before && !status().is_null(); }));
  }
  void kill_keeper_and_supervisor(Command& rig) const {
    const auto supervisor = rig.supervisor();
    rig.signal(SIGKILL);
    rig.wait();
    ASSERT_EQ(kill(supervisor, SIGKILL), 0);
    ASSERT_TRUE(eventually([&] { return !is_alive(supervisor); }));
  }
  void expect_all_alive(const std::vector<pid_t>& services) const {
    for (const auto pid : services) EXPECT_TRUE(is_alive(pid));
  }
};

TEST_F(Adoption, AKilledSupervisorIsReplacedWhileServicesAndLightGoOn) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  const auto light = view("projection.frames"), frames = view("camera.frames");
  const auto before = light.look();
  const auto camera_epoch = frames.epoch();

  // Other processes take light from both; the more rounds are summed, the less that matters.
  // After ten deaths in a minute the keeper gives up.
  constexpr int kFewest = 3, kMost = 9;
  std::uint64_t quiet = 0, disturbed = 0;
  int rounds = 0;
  for (; rounds < kFewest || (rounds < kMost && disturbed * 10 <= quiet * 9); ++rounds) {
    ASSERT_TRUE(eventually([&] { return rig->supervisor() > 0; }));
    const auto start = light.sequence();
    usleep(1'500'000);
    const auto middle = light.sequence();
    ASSERT_EQ(kill(rig->supervisor(), SIGKILL), 0);
    usleep(1'500'000);
    quiet += middle - start;
    disturbed += light.sequence() - middle;
  }
  std::printf("frames in %.1f s: %lu left alone, %lu while the supervisor was killed %d times\n",
              1.5 * rounds, quiet, disturbed, rounds);
  EXPECT_GT(quiet, 0u);
  EXPECT_GT(disturbed * 10, quiet * 9);

  ASSERT_TRUE(eventually([&] { return !status().is_null(); }));
  EXPECT_EQ(pids(), services);
  EXPECT_EQ(light.epoch(), before.epoch);  // no writer was replaced
  EXPECT_EQ(frames.epoch(), camera_epoch);
  for (const auto& name : kServices) EXPECT_EQ(service(name)["state"], "ready") << name;
  expect_more_light();
  EXPECT_GE(status()["uptime_s"], 9);  // of the rig, not of the supervisor

  rig->signal(SIGTERM);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  for (const auto pid : services) EXPECT_FALSE(is_alive(pid));
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(Adoption, AnAdoptedServiceThatDiesIsReplacedAndItsEndIsKnown) {
  const auto rig = up();
  wait_until_light();
  const auto light = view("projection.frames");
  replace_supervisor(*rig);
  const auto sequence = light.sequence(), epoch = light.epoch();
  const auto victim = service("projector")["pid"].get<pid_t>();
  ASSERT_EQ(kill(victim, SIGKILL), 0);
  ASSERT_TRUE(eventually([&] {
    const auto now = service("projector");
    return now["pid"] != victim && now["state"] == "ready";
  }));
  EXPECT_EQ(service("projector")["last_exit"], "signal 9 (Killed)");
  EXPECT_EQ(service("projector")["restarts"], 1);
  EXPECT_TRUE(eventually([&] { return light.epoch() == epoch + 1; }));
  EXPECT_GT(light.sequence(), sequence);  // the ring continues its sequence
}

TEST_F(Adoption, AServiceThatDiesWhileThereIsNoSupervisorIsStartedByTheNext) {
  const auto rig = up();
  wait_until_light();
  const auto supervisor = rig->supervisor();
  const auto before = pids();
  const auto victim = service("landmarks")["pid"].get<pid_t>();
  rig->signal(SIGSTOP);  // it must not start a successor yet
  ASSERT_EQ(kill(supervisor, SIGKILL), 0);
  ASSERT_TRUE(eventually([&] { return !is_alive(supervisor); }));
  ASSERT_EQ(kill(victim, SIGKILL), 0);
  ASSERT_TRUE(eventually([&] { return !is_alive(victim); }));
  rig->signal(SIGCONT);

  wait_until_light();
  EXPECT_NE(service("landmarks")["pid"], victim);
  EXPECT_THAT(rig->log(), HasSubstr("landmarks (pid " + std::to_string(victim) +
                                    ") died while there was no supervisor (signal 9 (Killed))"));
  for (const auto pid : before) EXPECT_EQ(is_alive(pid), pid != victim) << pid;
}

TEST_F(Adoption, WithoutKeeperAndSupervisorTheLightGoesOnAndTheNextUpTakesOver) {
  auto rig = up();
  wait_until_light();
  const auto services = pids();
  const auto light = view("projection.frames");
  kill_keeper_and_supervisor(*rig);
  const auto sequence = light.sequence();
  EXPECT_TRUE(eventually([&] { return light.sequence() > sequence + 30; }));

  rig = up({"--set", "observer.rate_hz=3"});
  wait_until_light();
  ASSERT_TRUE(eventually([&] {
    return service("observer")["pid"] != services.back() && service("observer")["state"] == "ready";
  }));
  auto now = pids();
  EXPECT_NE(now.back(), services.back());  // its settings have changed
  now.back() = services.back();
  EXPECT_EQ(now, services);

  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(rig->wait(), 0);
  for (const auto pid : services) EXPECT_FALSE(is_alive(pid));
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(Adoption, DownEndsServicesThatHaveNoSupervisor) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  kill_keeper_and_supervisor(*rig);
  expect_all_alive(services);
  const auto down = handcast({"down"});
  EXPECT_EQ(down.exit_code, 0) << down.log;
  EXPECT_THAT(down.output, HasSubstr(fmt::format(
                               "rig 'twin' had no supervisor that answered; processes ended: {}",
                               services.size())));
  for (const auto pid : services) EXPECT_FALSE(is_alive(pid));
  EXPECT_EQ(handcast({"down"}).exit_code, 111);
}

TEST_F(Adoption, ServicesThatCannotBeTakenOverAreNamedAndLeftAlone) {
  const auto rig = up();
  wait_until_light();
  const auto services = pids();
  kill_keeper_and_supervisor(*rig);
  auto other = state();
  for (auto& ring : other.rings) ring.inode = 1;
  ASSERT_TRUE(memory().save(other));

  const auto refused = up();
  EXPECT_EQ(refused->wait(), 111);
  EXPECT_THAT(refused->log(), AllOf(HasSubstr("camera (pid " + std::to_string(services[0]) + ")"),
                                    HasSubstr("cannot be taken over"),
                                    HasSubstr("`handcast down --rig twin` stops them")));
  expect_all_alive(services);
  EXPECT_EQ(handcast({"down", "--rig", "twin"}).exit_code, 0);
}

TEST_F(Adoption, TheTimeOfARunGoesOnUnderTheNextSupervisor) {
  const auto out = scratch_.path() / "out";
  const auto rig = up({"--seconds", "8", "--out", out.string(), "--set", "observer.enabled=false"});
  ASSERT_TRUE(eventually([&] { return service("projector")["state"] == "ready"; }));
  replace_supervisor(*rig);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
  const auto report = nlohmann::json::parse(std::ifstream(out / "live.json"), nullptr, false);
  EXPECT_GE(report["seconds"], 8);
  EXPECT_EQ(report["services"]["projector"]["restarts"], 0);
}

}  // namespace
}  // namespace handcast::system_test
