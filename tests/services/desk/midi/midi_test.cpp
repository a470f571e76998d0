// SPDX-License-Identifier: Apache-2.0
// The surface on an emulated port, which is plugged in and pulled.
#include "services/desk/midi/midi.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <mutex>
#include <thread>

#include "config/settings/files.hpp"
#include "ipc/base/clock.hpp"
#include "tests/scratch.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk {
namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;
using Message = std::vector<std::uint8_t>;

/// A controller with motors.
struct Device {
  std::mutex mutex;
  std::vector<Message> moved, shown;
  std::atomic<bool> is_plugged = true;

  void move(Message message) {
    const std::lock_guard lock(mutex);
    moved.push_back(std::move(message));
  }
  bool has_shown(const Message& message) {
    const std::lock_guard lock(mutex);
    return std::ranges::find(shown, message) != shown.end();
  }
};

class EmulatedPort final : public midi::Port {
 public:
  explicit EmulatedPort(std::shared_ptr<Device> device) : device_(std::move(device)) {}
  const std::string& name() const override { return name_; }
  std::vector<Message> receive() override {
    const std::lock_guard lock(device_->mutex);
    return std::exchange(device_->moved, {});
  }
  void send(std::span<const std::uint8_t> message) override {
    const std::lock_guard lock(device_->mutex);
    device_->shown.emplace_back(message.begin(), message.end());
  }
  bool is_there() override { return device_->is_plugged; }

 private:
  std::string name_ = "Fader 8";
  std::shared_ptr<Device> device_;
};

class Midi : public testing::Test {
 protected:
  void open() {
    rig.desk.midi.device = "Fader";
    auto opened =
        open_midi(rig, file, panel, nullptr,
                  [device = device](std::string_view) -> Result<std::unique_ptr<midi::Port>> {
                    if (!device->is_plugged) return fail(Errc::disconnected, "not there");
                    return std::make_unique<EmulatedPort>(device);
                  });
    ASSERT_TRUE(opened) << opened.error().what;
    midi = std::move(*opened);
  }
  template <class Condition>
  static bool comes_true(Condition condition) {
    for (const auto until = Deadline::in(20s); !until.passed(); std::this_thread::sleep_for(2ms))
      if (condition()) return true;
    return false;
  }

  test::Scratch scratch;
  std::filesystem::path file = scratch.path() / "rig.midi.toml";
  config::Rig rig;
  test::TablePanel panel;
  std::shared_ptr<Device> device = std::make_shared<Device>();
  std::unique_ptr<MidiSurface> midi;
};

TEST_F(Midi, IsOffByDefault) { EXPECT_EQ(*open_midi(rig, file, panel, nullptr), nullptr); }

TEST_F(Midi, AKnobIsLearnedTurnsAndIsRememberedByTheNextProcess) {
  open();
  ASSERT_TRUE(midi->learn("light.master"));
  EXPECT_EQ(midi->state().learning, "light.master");
  device->move({0xb0, 70, 1});
  EXPECT_TRUE(comes_true([&] { return midi->state().bindings.size() == 1; }));
  EXPECT_EQ(midi->state().bindings[0].second, "controller 70 of channel 1");
  device->move({0xb0, 70, 0});
  EXPECT_TRUE(comes_true([&] { return panel.value("light.master") == "0"; }));
  EXPECT_TRUE(comes_true([&] { return std::filesystem::exists(file); }));
  midi.reset();
  EXPECT_THAT(*config::read_text(file), HasSubstr("path = \"light.master\""));
  open();
  device->move({0xb0, 70, 127});
  EXPECT_TRUE(comes_true([&] { return panel.value("light.master") == "1"; }));
  midi->forget("light.master");
  EXPECT_TRUE(comes_true(
      [&] { return config::read_text(file)->find("light.master") == std::string::npos; }));
}

TEST_F(Midi, AMotorFollowsThePage) {
  std::ofstream(file) << "[[binding]]\npath = \"light.master\"\nsource = \"bend\"\n";
  open();
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=0"}, "page"));
  EXPECT_TRUE(comes_true([&] { return device->has_shown({0xe0, 0, 0}); }));
}

TEST_F(Midi, ADeviceMayBePulledAndPluggedIn) {
  std::ofstream(file) << "[[binding]]\npath = \"light.master\"\nnumber = 7\n";
  device->is_plugged = false;
  open();
  EXPECT_EQ(midi->state().device, "");
  device->is_plugged = true;
  EXPECT_TRUE(comes_true([&] { return midi->state().device == "Fader 8"; }));
  device->is_plugged = false;
  EXPECT_TRUE(comes_true([&] { return midi->state().device.empty(); }));
  device->is_plugged = true;
  device->move({0xb0, 7, 0});
  EXPECT_TRUE(comes_true([&] { return panel.value("light.master") == "0"; }));
}

TEST_F(Midi, ABrokenFileIsRefused) {
  std::ofstream(file) << "[[binding]]\npath = \"light.mastr\"\n";
  rig.desk.midi.device = "Fader";
  const auto opened = open_midi(rig, file, panel, nullptr);
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().what, HasSubstr("rig.midi.toml:1: there is no live setting"));
}

}  // namespace
}  // namespace handcast::desk
