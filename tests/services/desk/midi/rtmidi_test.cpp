// SPDX-License-Identifier: Apache-2.0
// The surface below the real library: against an ALSA sequencer if the kernel has one, and against
// a JACK server of its own, which has no sound card.
#include <gmock/gmock.h>

#include <filesystem>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/desk/midi/midi.hpp"
#include "tests/midi_devices.hpp"
#include "tests/scratch.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;
using test::EmulatedController;

template <class Condition>
bool comes_true(Condition condition) {
  for (const auto until = Deadline::in(20s); !until.passed(); std::this_thread::sleep_for(5ms))
    if (condition()) return true;
  return false;
}

/// Learns a fader, moves it, is moved, is pulled and plugged in again.
void exercise(RtMidi::Api api, const std::string& device) {
  const test::Scratch scratch;
  test::TablePanel panel;
  config::Rig rig;
  rig.desk.midi.device = device;
  std::optional<EmulatedController> controller(api);
  auto midi = open_midi(rig, scratch.path() / "rig.midi.toml", panel, nullptr);
  ASSERT_TRUE(midi) << midi.error().what;
  ASSERT_TRUE(comes_true([&] { return !(*midi)->state().device.empty(); }));
  ASSERT_TRUE((*midi)->learn("light.master"));
  ASSERT_TRUE(comes_true([&] {
    controller->move({0xe0, 0, 64});
    return !(*midi)->state().bindings.empty();
  }));
  EXPECT_EQ((*midi)->state().bindings[0].second, "bend of channel 1");
  controller->move({0xe0, 0, 0});
  EXPECT_TRUE(comes_true([&] { return panel.value("light.master") == "0"; }));
  ASSERT_TRUE(panel.set(std::vector<std::string>{"light.master=1"}, "page"));
  EXPECT_TRUE(comes_true([&] { return controller->has_shown({0xe0, 127, 127}); }));

  controller.reset();
  EXPECT_TRUE(comes_true([&] { return (*midi)->state().device.empty(); }));
  controller.emplace(api);
  EXPECT_TRUE(comes_true([&] { return !(*midi)->state().device.empty(); }));
  EXPECT_TRUE(comes_true([&] {
    controller->move({0xe0, 0, 0});
    return panel.value("light.master") == "0";
  }));
}

TEST(RtMidi, AnAlsaControllerIsLearnedMovedAndPulled) {
  if (!std::filesystem::exists("/dev/snd/seq"))
    GTEST_SKIP() << "this kernel has no ALSA sequencer: there is no /dev/snd/seq";
  exercise(RtMidi::LINUX_ALSA, "Emulated Fader");
}

TEST(RtMidi, AJackControllerIsLearnedMovedAndPulled) {
  const test::JackServer server;
  if (!server) GTEST_SKIP() << test::JackServer::why();
  exercise(RtMidi::UNIX_JACK, "jack:Emulated Fader");
}

TEST(RtMidi, AComputerWithoutADeviceSaysWhatThereIs) {
  const auto port = midi::open_port("no such device");
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().what, testing::HasSubstr("MIDI"));
}

}  // namespace
}  // namespace handcast::desk
