// SPDX-License-Identifier: Apache-2.0
// The study on a screen, answered by the buttons of a MIDI device: against a real JACK server.
#include "tests/midi_devices.hpp"
#include "tests/services/studies/study_on_screen.hpp"

namespace handcast::study {
namespace {

TEST_F(Screen, TheButtonsOfAMidiDeviceAnswer) {
  const test::JackServer server;
  if (!server) GTEST_SKIP() << test::JackServer::why();
  study_until(1);  // which is asked for no consent any more
  const auto asked = log().rows.size();
  ASSERT_GT(asked, 0u) << said();
  test::EmulatedController pads(RtMidi::UNIX_JACK);
  Running study(command("--midi 'jack:Emulated Fader'"));
  // The first key is learned for 1 and the second one for 2; then one answers after the other.
  const std::vector<unsigned char> first{0x90, 36, 100}, second{0x90, 38, 100};
  const auto press_until = [&](const auto& button, const auto& is_done) {
    for (const auto end = Deadline::in(kPatience); !is_done() && !end.passed();) {
      ASSERT_FALSE(study.exit_code()) << said();
      pads.move(button);
      std::this_thread::sleep_for(100ms);
    }
  };
  press_until(first, [&] { return said().find("answers 1") != std::string::npos; });
  press_until(second, [&] { return said().find("answers 2") != std::string::npos; });
  press_until(first, [&] { return log().rows.size() > asked; });
  press_until(second, [&] { return log().rows.size() > asked + 1; });
  const auto answered = log();
  ASSERT_EQ(answered.rows.size(), asked + 2) << said();
  const auto answer = *answered.column("answer");
  EXPECT_EQ(answered.rows[asked][answer], "1");
  EXPECT_EQ(answered.rows[asked + 1][answer], "2");
}

TEST_F(Screen, AMidiDeviceThatIsNotThereIsNamed) {
  Running study(command("--midi 'jack:no such device'"));
  for (const auto end = Deadline::in(kPatience); !study.exit_code() && !end.passed();)
    std::this_thread::sleep_for(20ms);
  EXPECT_NE(study.exit_code().value_or(0), 0);
  EXPECT_NE(said().find("--midi: "), std::string::npos) << said();
}

}  // namespace
}  // namespace handcast::study
