// SPDX-License-Identifier: Apache-2.0
// A rig whose projector is commanded. Its processes see an emulated controller.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>

#include "tests/services/projector/dlp/emulated_controller.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using dlp::protocol::Controller;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kLimit = 0.4;

class CommandedProjector : public SystemTest {
 protected:
  void SetUp() override {
    if (!test::sees_emulated_devices())
      GTEST_SKIP() << "there are no emulated devices: umockdev-wrapper is not installed, or "
                      "sanitizers must be loaded first";
    SystemTest::SetUp();
    device_ = std::make_unique<test::EmulatedController>(Controller::dlpc350);
  }
  void TearDown() override {
    SystemTest::TearDown();
    if (!device_) return;
    EXPECT_THAT(device_->complaints(), IsEmpty());
    EXPECT_LE(device_->highest_current(), kLimit);
  }
  std::unique_ptr<Command> up_commanded() const {
    return up({"--set", "dlp.backend=lightcrafter", "--set", "dlp.mode=pattern", "--set",
               "dlp.limit=0.4", "--set", "projector.packing=24x1", "--set",
               "projector.rate_hz=1440", "--set", "observer.enabled=false"});
  }
  /// By the service, not by its own firmware.
  bool becomes_lit() const {
    const test::Received on{
        .is_read = false, .command = dlp::protocol::Command::led_enables, .data = {0x0f}};
    return eventually([&] {
      const auto received = device_->received();
      return std::ranges::find(received, on) != received.end() && device_->is_lit() &&
             device_->is_running();
    });
  }
  pid_t pid() const {
    const auto now = status();
    if (now.is_null()) return -1;
    const auto& service = now["services"]["dlp"];
    return service["state"] == "ready" ? service["pid"].get<pid_t>() : -1;
  }
  /// The first messages after a forget() are those of the safe state.
  void expect_darkness_first() const {
    ASSERT_TRUE(eventually([&] { return !device_->received().empty(); }));
    const auto received = device_->received();
    EXPECT_FALSE(received.front().is_read);
    EXPECT_EQ(received.front().command, dlp::protocol::Command::led_enables);
    EXPECT_EQ(received.front().data, dlp::protocol::Bytes{0});
  }

  std::unique_ptr<test::EmulatedController> device_;
};

TEST_F(CommandedProjector, IsLitAndDownLeavesItDark) {
  const auto rig = up_commanded();
  ASSERT_TRUE(becomes_lit()) << rig->log();
  expect_darkness_first();
  EXPECT_TRUE(eventually([&] { return pid() > 0; }));
  EXPECT_THAT(rig->log(), HasSubstr("DLPC350 (serial LCR7, /dev/hidraw0), firmware 4.1.2"));
  EXPECT_THAT(handcast({"status"}).output, HasSubstr("dlp"));
  EXPECT_EQ(handcast({"top", "--once"}).exit_code, 0);
  device_->set_hardware_status(0x81);
  EXPECT_TRUE(eventually([&] {
    return rig->log().find("the projector reports: its sequencer reports an error") !=
           std::string::npos;
  }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_FALSE(device_->is_lit());
  EXPECT_FALSE(device_->is_running());
  EXPECT_EQ(rig->wait(), 0);
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(CommandedProjector, AServiceThatIsKilledIsFollowedByOneThatDarkensItFirst) {
  const auto rig = up_commanded();
  ASSERT_TRUE(becomes_lit()) << rig->log();
  ASSERT_TRUE(eventually([&] { return pid() > 0; }));
  for (int i = 0; i < 2; ++i) {
    const auto victim = pid();
    kill(victim, SIGSTOP);  // so that it says nothing after forget()
    usleep(50'000);
    device_->forget();
    ASSERT_EQ(kill(victim, SIGKILL), 0);
    ASSERT_TRUE(eventually([&] { return pid() > 0 && pid() != victim; })) << rig->log();
    expect_darkness_first();
    ASSERT_TRUE(becomes_lit());
  }
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_FALSE(device_->is_lit());
}

TEST_F(CommandedProjector, AServiceThatHangsAtTheEndLeavesDarknessBehind) {
  const auto rig = up_commanded();
  ASSERT_TRUE(becomes_lit()) << rig->log();
  ASSERT_TRUE(eventually([&] { return pid() > 0; }));
  kill(pid(), SIGSTOP);
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_FALSE(device_->is_lit());
  rig->wait();
  EXPECT_THAT(traces(), IsEmpty());
}

TEST_F(CommandedProjector, CheckFindsASequenceThatCannotBeShown) {
  const auto outcome = handcast({"config", "--check", "config/rigs/twin.toml", "--set",
                                 "dlp.backend=lightcrafter", "--set", "dlp.mode=pattern"});
  EXPECT_EQ(outcome.exit_code, 100);
  EXPECT_THAT(outcome.log + outcome.output, HasSubstr("projector.packing"));
  EXPECT_THAT(device_->received(), IsEmpty());
}

}  // namespace
}  // namespace handcast::system_test
