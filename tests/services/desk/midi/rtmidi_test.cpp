// SPDX-License-Identifier: Apache-2.0
// The surface below the real library: against an ALSA sequencer if the kernel has one, and against
// a JACK server of its own, which has no sound card.
#include <RtMidi.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/desk/midi/midi.hpp"
#include "tests/scratch.hpp"
#include "tests/services/desk/table_panel.hpp"

extern char** environ;

namespace handcast::desk {
namespace {

using namespace std::chrono_literals;
using Message = std::vector<unsigned char>;

template <class Condition>
bool comes_true(Condition condition) {
  for (const auto until = Deadline::in(20s); !until.passed(); std::this_thread::sleep_for(5ms))
    if (condition()) return true;
  return false;
}

/// A controller with motors: virtual ports of this process.
class EmulatedController {
 public:
  explicit EmulatedController(RtMidi::Api api)
      : out_(api, "Emulated Fader"), in_(api, "Emulated Fader") {
    in_.setCallback(
        [](double, Message* message, void* self) {
          auto& controller = *static_cast<EmulatedController*>(self);
          const std::lock_guard lock(controller.mutex_);
          controller.shown_.push_back(*message);
        },
        this);
    out_.openVirtualPort("moved");
    in_.openVirtualPort("shown");
  }
  void move(const Message& message) { out_.sendMessage(&message); }
  bool has_shown(const Message& message) {
    const std::lock_guard lock(mutex_);
    return std::ranges::find(shown_, message) != shown_.end();
  }

 private:
  std::mutex mutex_;
  std::vector<Message> shown_;
  RtMidiOut out_;
  RtMidiIn in_;
};

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
  if (std::system("command -v jackd >/dev/null") != 0)
    GTEST_SKIP() << "jackd is not installed (jackd1)";
  const auto name = "handcast-test-" + std::to_string(::getpid());
  ::setenv("JACK_DEFAULT_SERVER", name.c_str(), 1);
  std::string command = "exec timeout 90 jackd -n " + name + " -r -d dummy -p 256 >/dev/null 2>&1";
  char* const arguments[] = {const_cast<char*>("sh"), const_cast<char*>("-c"), command.data(),
                             nullptr};
  pid_t server = 0;
  ASSERT_EQ(::posix_spawn(&server, "/bin/sh", nullptr, nullptr, arguments, environ), 0);
  const auto socket = fmt::format("/dev/shm/jack-{}/{}/jack_0", ::getuid(), name);
  ASSERT_TRUE(comes_true([&] { return std::filesystem::exists(socket); })) << socket;
  exercise(RtMidi::UNIX_JACK, "jack:Emulated Fader");
  ::kill(server, SIGTERM);
  ::waitpid(server, nullptr, 0);
}

TEST(RtMidi, AComputerWithoutADeviceSaysWhatThereIs) {
  const auto port = midi::open_port("no such device");
  ASSERT_FALSE(port);
  EXPECT_THAT(port.error().what, testing::HasSubstr("desk.midi.device: "));
}

}  // namespace
}  // namespace handcast::desk
