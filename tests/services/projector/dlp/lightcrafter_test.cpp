// SPDX-License-Identifier: Apache-2.0
// The contract of all controllers, on emulated USB devices through the real hidapi.
#include <gmock/gmock.h>

#include "services/projector/dlp/dlp_controller.hpp"
#include "tests/services/projector/dlp/emulated_controller.hpp"

namespace handcast::dlp {
namespace {

using namespace std::chrono_literals;
using protocol::Bytes;
using protocol::Command;
using protocol::Controller;
using test::EmulatedController;
using test::Fault;
using test::Received;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr double kLimit = 0.4;

Received write_of(Command command, const Bytes& data) {
  return {.is_read = false, .command = command, .data = data};
}

class LightCrafterTest : public testing::TestWithParam<Controller> {
 protected:
  void SetUp() override {
    if (!test::sees_emulated_devices())
      GTEST_SKIP() << "there are no emulated devices: umockdev-wrapper is not installed, or "
                      "sanitizers must be loaded first";
    device_ = std::make_unique<EmulatedController>(GetParam());
    rig_.dlp.backend = "lightcrafter";
    rig_.dlp.limit = kLimit;
    rig_.dlp.red = rig_.dlp.green = 0.3;
    rig_.dlp.blue = 0.4;
    rig_.projector.packing = config::Packing::planes_24x1;
    rig_.projector.rate_hz = 1440;
  }
  void TearDown() override {
    if (!device_) return;
    EXPECT_THAT(device_->complaints(), IsEmpty());
    EXPECT_LE(device_->highest_current(), kLimit);
  }

  std::unique_ptr<DlpController> open() const { return std::move(open_dlp(rig_).value()); }
  /// Darkens it, and tends it until it waits for nothing but a signal.
  Health bring_up(DlpController& controller) const {
    const auto dark = controller.darken(Deadline::in(5s));
    EXPECT_TRUE(dark) << dark.error().what;
    for (int i = 0; i < 20; ++i) {
      const auto health = controller.tend(Deadline::in(5s));
      if (!health) throw std::runtime_error(health.error().what);
      if (health->waits_for.empty() || health->waits_for == "a video signal") return *health;
    }
    throw std::runtime_error("it never lights");
  }
  bool is_350() const { return GetParam() == Controller::dlpc350; }

  config::Rig rig_;
  std::unique_ptr<EmulatedController> device_;
};

INSTANTIATE_TEST_SUITE_P(All, LightCrafterTest,
                         testing::Values(Controller::dlpc350, Controller::dlpc900),
                         [](const auto& row) { return std::string(name_of(row.param)); });

TEST_P(LightCrafterTest, NamesItself) {
  EXPECT_THAT(
      open()->identify(Deadline::in(5s)).value(),
      AllOf(HasSubstr(std::string(name_of(GetParam()))), HasSubstr("LCR7"), HasSubstr("4.1.2")));
}

TEST_P(LightCrafterTest, OpeningSendsNothing) {
  open();
  EXPECT_THAT(device_->received(), IsEmpty());
}

TEST_P(LightCrafterTest, TheSafeStateBeginsWithTheLeds) {
  EXPECT_TRUE(device_->is_lit());  // by its firmware
  ASSERT_TRUE(open()->darken(Deadline::in(5s)));
  EXPECT_FALSE(device_->is_lit());
  EXPECT_FALSE(device_->is_running());
  const std::uint8_t dark = is_350() ? 255 : 0;
  const auto received = device_->received();
  ASSERT_THAT(received, SizeIs(4));
  EXPECT_EQ(received[0], write_of(Command::led_enables, {0}));
  EXPECT_EQ(received[1], write_of(Command::pattern_display, {0}));
  EXPECT_EQ(received[2], write_of(Command::led_currents, {dark, dark, dark}));
  EXPECT_TRUE(received[3].is_read);
}

TEST_P(LightCrafterTest, ABoardWithOtherLedDriversGetsTheirSignal) {
  rig_.dlp.signal = is_350() ? config::LedSignal::direct : config::LedSignal::inverted;
  device_->exchange_led_drivers();
  const auto controller = open();
  bring_up(*controller);
  EXPECT_TRUE(device_->is_lit());
  EXPECT_NEAR(device_->highest_current(), 0.4, 0.004);
  ASSERT_TRUE(controller->darken(Deadline::in(5s)));
  const std::uint8_t dark = is_350() ? 0 : 255;
  EXPECT_THAT(device_->received(), Contains(write_of(Command::led_currents, {dark, dark, dark})));
}

TEST_P(LightCrafterTest, VideoModeLightsWithTheCurrentsOfTheRig) {
  const auto controller = open();
  const auto health = bring_up(*controller);
  EXPECT_EQ(health.waits_for, "");
  EXPECT_TRUE(device_->is_lit());
  EXPECT_NEAR(device_->highest_current(), 0.4, 0.004);
  const auto received = device_->received();
  EXPECT_THAT(received, Contains(write_of(Command::display_mode, {0})));
  EXPECT_THAT(received, Contains(write_of(Command::led_enables, {0x0f})));
  ASSERT_TRUE(controller->darken(Deadline::in(5s)));
  EXPECT_FALSE(device_->is_lit());
}

TEST_P(LightCrafterTest, PatternModeShowsTheBitPlanes) {
  rig_.dlp.mode = config::DlpMode::pattern;
  for (const auto packing : {config::Packing::planes_24x1, config::Packing::planes_8x3}) {
    rig_.projector.packing = packing;
    rig_.projector.rate_hz = packing == config::Packing::planes_24x1 ? 1440 : 480;
    device_->restart();
    device_->forget();
    const auto controller = open();
    bring_up(*controller);
    EXPECT_TRUE(device_->is_lit());
    EXPECT_TRUE(device_->is_running());
    const auto received = device_->received();
    const auto definitions =
        std::ranges::count(received, Command::pattern_definition, &Received::command);
    EXPECT_EQ(definitions, is_350() ? 1 : 24);
    EXPECT_THAT(received,
                Contains(write_of(Command::display_mode, {is_350() ? Bytes{1} : Bytes{2}})));
  }
}

TEST_P(LightCrafterTest, TheLedsAreSwitchedOnAfterTheirCurrentsAreSet) {
  rig_.dlp.mode = config::DlpMode::pattern;
  const auto controller = open();
  bring_up(*controller);
  std::vector<Command> order;
  for (const auto& message : device_->received())
    if (!message.is_read) order.push_back(message.command);
  const auto enabled = std::ranges::find(order.begin() + 3, order.end(), Command::led_enables);
  const auto current = std::ranges::find(order.begin() + 3, order.end(), Command::led_currents);
  const auto defined = std::ranges::find(order, Command::pattern_definition);
  ASSERT_NE(enabled, order.end());
  EXPECT_LT(defined, current);
  EXPECT_LT(current, enabled);
}

TEST_P(LightCrafterTest, WithoutAVideoSignalItStaysDarkAndWaits) {
  for (const auto mode : {config::DlpMode::video, config::DlpMode::pattern}) {
    rig_.dlp.mode = mode;
    device_->set_signal(false);
    const auto controller = open();
    EXPECT_EQ(bring_up(*controller).waits_for, "a video signal");
    EXPECT_FALSE(device_->is_lit());
    device_->set_signal(true);
    EXPECT_EQ(bring_up(*controller).waits_for, "");
    EXPECT_TRUE(device_->is_lit());
    device_->set_signal(false);  // the cable is pulled
    const auto health = controller->tend(Deadline::in(5s));
    ASSERT_TRUE(health);
    EXPECT_THAT(health->events, ElementsAre(HasSubstr("video signal is lost")));
    EXPECT_FALSE(device_->is_lit());
  }
}

// Its firmware's own currents may be above the limit.
TEST_P(LightCrafterTest, AControllerThatRestartsIsDarkenedBeforeItIsLitAgain) {
  const auto controller = open();
  bring_up(*controller);
  device_->restart();
  device_->forget();
  const auto health = controller->tend(Deadline::in(5s));
  ASSERT_TRUE(health);
  EXPECT_THAT(health->events, Contains(HasSubstr("lost its settings")));
  std::vector<Received> written;
  for (const auto& message : device_->received())
    if (!message.is_read) written.push_back(message);
  ASSERT_FALSE(written.empty());
  EXPECT_EQ(written.front(), write_of(Command::led_enables, {0}));
}

TEST_P(LightCrafterTest, FaultsAreSentences) {
  const auto controller = open();
  bring_up(*controller);
  device_->set_hardware_status(0x81);
  const auto health = controller->tend(Deadline::in(5s));
  ASSERT_TRUE(health);
  EXPECT_THAT(health->faults, ElementsAre(HasSubstr("sequencer reports an error")));
}

TEST_P(LightCrafterTest, OneDamagedReplyIsSurvived) {
  for (const auto fault : {Fault::silence, Fault::lost_reply, Fault::short_report, Fault::cut_reply,
                           Fault::wrong_sequence, Fault::stray_first, Fault::absurd_length}) {
    const auto controller = open();
    device_->inject({fault});
    EXPECT_TRUE(controller->darken(Deadline::in(5s))) << static_cast<int>(fault);
    EXPECT_FALSE(device_->is_lit());
    device_->inject({Fault::none, Fault::none, fault});
    EXPECT_TRUE(controller->tend(Deadline::in(5s))) << static_cast<int>(fault);
  }
}

TEST_P(LightCrafterTest, ARefusedSettingIsNamed) {
  const auto controller = open();
  ASSERT_TRUE(controller->darken(Deadline::in(5s)));
  const Fault ok = Fault::none;
  // Status (three bytes), on the DLPC350 the signal, power; then the first command that sets
  // something.
  std::vector<Fault> faults(is_350() ? 5 : 4, ok);
  faults.push_back(Fault::refusal);
  device_->inject(faults);
  const auto health = controller->tend(Deadline::in(5s));
  ASSERT_FALSE(health);
  EXPECT_EQ(health.error().code, Errc::unavailable);
  EXPECT_THAT(health.error().what,
              AllOf(HasSubstr("refuses"), HasSubstr(is_350() ? "input source" : "display mode")));
  EXPECT_FALSE(device_->is_lit());
}

TEST_P(LightCrafterTest, ADeviceThatDoesNotAnswerIsDisconnected) {
  const auto controller = open();
  device_->inject({Fault::silence, Fault::silence});
  const auto dark = controller->darken(Deadline::in(5s));
  ASSERT_FALSE(dark);
  EXPECT_EQ(dark.error().code, Errc::disconnected);
}

TEST_P(LightCrafterTest, ADeadlineInThePastIsAnErrorNotAHang) {
  const auto controller = open();
  EXPECT_FALSE(controller->darken(Deadline::now()));
  EXPECT_FALSE(controller->tend(Deadline::now()));
  EXPECT_FALSE(controller->identify(Deadline::now()));
}

TEST_P(LightCrafterTest, UnpluggedInTheMiddleItIsDisconnectedAndCanBeOpenedAgain) {
  const auto controller = open();
  bring_up(*controller);
  device_->unplug();
  const auto health = controller->tend(Deadline::in(5s));
  ASSERT_FALSE(health);
  EXPECT_EQ(health.error().code, Errc::disconnected);
  const auto absent = open_dlp(rig_);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Errc::unavailable);
  EXPECT_THAT(absent.error().what, HasSubstr("USB cable"));
  device_->plug();
  EXPECT_EQ(bring_up(*open()).waits_for, "");
}

TEST_P(LightCrafterTest, IsFoundByItsSerialNumberOrPath) {
  for (const auto* name : {"", "LCR7", "/dev/hidraw0"}) {
    rig_.dlp.device = name;
    EXPECT_TRUE(open_dlp(rig_)) << name;
  }
  rig_.dlp.device = "LCR8";
  const auto other = open_dlp(rig_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Errc::unavailable);
  EXPECT_THAT(other.error().what, AllOf(HasSubstr("LCR8"), HasSubstr("LCR7")));
}

TEST_P(LightCrafterTest, ASequenceThatCannotBeShownIsAnErrorAfterTheSafeState) {
  rig_.dlp.mode = config::DlpMode::pattern;
  rig_.projector.rate_hz = 240 * 24;
  if (!is_350()) rig_.dlp.trigger_in = true;
  const auto controller = open();
  ASSERT_TRUE(controller->darken(Deadline::in(5s)));
  const auto health = controller->tend(Deadline::in(5s));
  ASSERT_FALSE(health);
  EXPECT_EQ(health.error().code, Errc::bad_config);
  EXPECT_THAT(health.error().what, HasSubstr(is_350() ? "235 µs" : "dlp.trigger_in"));
  EXPECT_FALSE(device_->is_lit());
}

TEST(DlpCheck, FindsASequenceThatNoControllerShows) {
  config::Rig rig;
  rig.dlp.backend = "lightcrafter";
  EXPECT_TRUE(check_dlp(rig));
  rig.dlp.mode = config::DlpMode::pattern;
  ASSERT_FALSE(check_dlp(rig));
  EXPECT_THAT(check_dlp(rig).error().what, HasSubstr("projector.packing"));
  rig.projector.packing = config::Packing::planes_24x1;
  rig.projector.rate_hz = 1440;
  EXPECT_TRUE(check_dlp(rig));
}

}  // namespace
}  // namespace handcast::dlp
