// SPDX-License-Identifier: Apache-2.0
// A rig with two projectors, whose processes share the light of the twin's hand.
#include <gmock/gmock.h>
#include <signal.h>

#include <cmath>

#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;

class TwoProjectors : public SystemTest {
 protected:
  std::unique_ptr<Command> both() const {
    Arguments more;
    for (const auto* setting :
         {"calibration=config/calibrations/left_of_two.toml", "projector2.backend=twin",
          "projector2.calibration=config/calibrations/right_of_two.toml", "projector2.rate_hz=60",
          "twin.motion=builtin:still", "content.left=builtin:white", "content.right=builtin:white",
          "projector.fade_s=0", "projector2.fade_s=0"})
      more.insert(more.end(), {"--set", setting});
    return up(more);
  }
  bool is_ready(const char* name) const { return service(name)["state"] == "ready"; }
};

/// The sum of the levels of the newest frame of a stream.
double light_of(client::Stream<msg::Projection>& frames) {
  const auto frame = frames.latest(Deadline::in(2s));
  if (!frame) return 0;
  double sum = 0;
  const auto count = std::size_t{(*frame)->region_width_px} * (*frame)->region_height_px;
  for (std::size_t i = 0; i < count; ++i) sum += (*frame)->pixels()[i] & 0xff;
  return sum;
}

TEST_F(TwoProjectors, OneLightsTheHandAloneUntilTheOtherIsBack) {
  const auto rig = both();
  wait_until_light();
  ASSERT_TRUE(eventually([&] { return is_ready("projector2"); })) << rig->log();
  const Variable scope(control::kScopeVariable, scratch_.path().string());
  auto frames = client::open_stream<msg::Projection>("twin", "projection.frames");
  ASSERT_TRUE(frames) << frames.error().what;
  double shared = 0;
  ASSERT_TRUE(eventually([&] {
    const double before = shared;
    shared = light_of(*frames);
    return shared > 0 && std::abs(shared / before - 1) < 0.02;
  }));
  EXPECT_THAT(handcast({"latency"}).output, testing::ContainsRegex("projector2 +[0-9]+ +60.0 Hz"));
  EXPECT_THAT(handcast({"status"}).output, AllOf(testing::HasSubstr("light of projector: "),
                                                 testing::HasSubstr("light of projector2: ")));
  // Stopped, not killed: it stays away until the supervisor has noticed.
  const auto pid = service("projector2")["pid"].get<pid_t>();
  ::kill(pid, SIGSTOP);
  EXPECT_TRUE(eventually([&] { return light_of(*frames) > 1.15 * shared; })) << shared;
  EXPECT_TRUE(eventually([&] {
    return service("projector2")["pid"] != pid && light_of(*frames) < 1.05 * shared;
  })) << rig->log();
}

TEST_F(TwoProjectors, WithoutACalibrationOfTheSecondTheRigSaysWhatIsMissing) {
  const auto refused =
      handcast({"up", "config/rigs/twin.toml", "--set", "projector2.backend=twin"});
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_NE((refused.output + refused.log).find("projector2.calibration is empty"),
            std::string::npos)
      << refused.output << refused.log;
}

}  // namespace
}  // namespace handcast::system_test
