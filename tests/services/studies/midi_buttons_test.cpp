// SPDX-License-Identifier: Apache-2.0
#include "services/studies/jnd/midi_buttons.hpp"

#include <gmock/gmock.h>

#include "ipc/base/clock.hpp"

namespace handcast::study {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Message = std::vector<std::uint8_t>;

/// A box with pads, which can be pulled.
struct Pads {
  std::vector<Message> pressed;
  bool is_plugged = true;
};

class PadsPort final : public desk::midi::Port {
 public:
  explicit PadsPort(std::shared_ptr<Pads> pads) : pads_(std::move(pads)) {}
  const std::string& name() const override { return name_; }
  std::vector<Message> receive() override { return std::exchange(pads_->pressed, {}); }
  void send(std::span<const std::uint8_t>) override {}
  bool is_there() override { return pads_->is_plugged; }

 private:
  std::string name_ = "Pads";
  std::shared_ptr<Pads> pads_;
};

class Buttons : public testing::Test {
 protected:
  Result<MidiButtons> open() const {
    return MidiButtons::open(
        "Pads", [pads = pads_](std::string_view) -> Result<std::unique_ptr<desk::midi::Port>> {
          if (!pads->is_plugged) return fail(Errc::disconnected, "it is not there");
          return std::make_unique<PadsPort>(pads);
        });
  }
  /// With the key 40 for "1", the pedal 64 for "2".
  MidiButtons taught() const {
    auto buttons = *open();
    press({{0x90, 40, 90}});
    EXPECT_TRUE(buttons.learn("1"));
    press({{0xb0, 64, 127}});
    EXPECT_TRUE(buttons.learn("2"));
    return buttons;
  }
  void press(std::vector<Message> messages) const { pads_->pressed = std::move(messages); }

  std::shared_ptr<Pads> pads_ = std::make_shared<Pads>();
};

TEST_F(Buttons, AKeyAndAPedalAreLearnedAndAnswer) {
  auto buttons = taught();
  press({{0x80, 40, 0}, {0x90, 41, 90}, {0xb0, 64, 127}, {0xb0, 64, 0}, {0x90, 40, 1}});
  EXPECT_THAT(buttons.take_keys(), ElementsAre("2", "1"));
  EXPECT_THAT(buttons.take_keys(), IsEmpty());
}

TEST_F(Buttons, ReleasesAndKnobsAreNoButtons) {
  auto buttons = *open();
  press({{0x90, 40, 0}, {0x80, 40, 64}, {0xb0, 1, 63}, {0xe0, 0, 64}, {0xf8}, {}});
  EXPECT_FALSE(buttons.learn("1"));
}

TEST_F(Buttons, OneButtonIsNotBothAnswers) {
  auto buttons = *open();
  press({{0x90, 40, 90}});
  EXPECT_TRUE(buttons.learn("1"));
  press({{0x90, 40, 90}});
  EXPECT_FALSE(buttons.learn("2"));
  press({{0x91, 40, 90}});
  EXPECT_TRUE(buttons.learn("2")) << "of another channel";
}

TEST_F(Buttons, ADeviceThatWasPulledAnswersAgainWhenItIsBack) {
  auto buttons = taught();
  pads_->is_plugged = false;
  const auto press_for = [&](double seconds) {
    std::vector<std::string> keys;
    for (const auto end = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(seconds)));
         keys.empty() && !end.passed(); sleep_until_ns(now_ns() + 5'000'000)) {
      press({{0x90, 40, 90}});
      keys = buttons.take_keys();
    }
    return keys;
  };
  for (const auto end = Deadline::in(std::chrono::seconds(20)); !press_for(0.05).empty();)
    ASSERT_FALSE(end.passed());
  pads_->is_plugged = true;
  EXPECT_THAT(press_for(20), ElementsAre("1"));
}

TEST_F(Buttons, ADeviceThatIsNotThereAtTheStartIsAnError) {
  pads_->is_plugged = false;
  EXPECT_EQ(open().error().code, Errc::disconnected);
}

}  // namespace
}  // namespace handcast::study
