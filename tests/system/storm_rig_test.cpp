// SPDX-License-Identifier: Apache-2.0
// Random services of a running rig are killed.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>

#include "ipc/base/clock.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;

constexpr double kProjector_hz = 60;

class RigStorm : public SystemTest {
 protected:
  /// The number of frames of the projector in this time, as a fraction of the wanted number.
  double share_of_light_during(const std::function<void()>& what) const {
    const auto frames = light();
    const auto start_ns = now_ns();
    what();
    return static_cast<double>(light() - frames) /
           (ns_to_seconds(now_ns() - start_ns) * kProjector_hz);
  }

  /// The pid of a service; 0 while it is being restarted.
  pid_t pid_of(const std::string& name) const { return service(name)["pid"].get<pid_t>(); }

  void kill_one_of(const std::vector<std::string>& names, std::mt19937& random) const {
    const auto& name = names[random() % names.size()];
    if (const auto pid = pid_of(name); pid > 0) ::kill(pid, SIGKILL);
    sleep_until_ns(now_ns() + ms_to_ns(100 + static_cast<double>(random() % 300)));
  }

  bool all_are_ready() const {
    const auto now = status();
    return std::ranges::all_of(
        kServices, [&](const auto& name) { return now["services"][name]["state"] == "ready"; });
  }
};

TEST_F(RigStorm, KillingServicesAtRandomEndsNeitherTheSupervisorNorTheLight) {
  std::mt19937 random(3);
  const auto rig = up();
  wait_until_light();
  for (int i = 0; i < 20; ++i) kill_one_of(kServices, random);
  EXPECT_TRUE(rig->running());
  EXPECT_TRUE(eventually([this] { return all_are_ready(); })) << status().dump(1);
  expect_more_light();
  rig->signal(SIGINT);
  EXPECT_EQ(rig->wait(), 0) << rig->log();
}

TEST_F(RigStorm, TheProjectorGoesOnWhileTheOthersAreKilled) {
  std::mt19937 random(5);
  const auto rig = up();
  wait_until_light();
  const auto projector = pid_of("projector");
  const double quiet = share_of_light_during([] { sleep_until_ns(now_ns() + to_ns(3s)); });
  const double stormy = share_of_light_during([&] {
    for (int i = 0; i < 10; ++i) kill_one_of({"camera", "pose", "landmarks", "observer"}, random);
  });
  std::printf("frames of the light, of those wanted: %.1f %% without kills, %.1f %% with kills\n",
              100 * quiet, 100 * stormy);
  EXPECT_EQ(pid_of("projector"), projector);
  EXPECT_GT(stormy, 0.9 * quiet);  // a busy machine loses frames, too; `scripts/soak` is exact
}

}  // namespace
}  // namespace handcast::system_test
