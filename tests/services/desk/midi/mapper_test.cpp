// SPDX-License-Identifier: Apache-2.0
#include "services/desk/midi/mapper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/services/desk/recorded_cues.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk::midi {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::int64_t kMs_ns = 1'000'000;

class MidiMapper : public testing::Test {
 protected:
  void bind(std::vector<Binding> bindings) {
    mapper.emplace(panel.controls(), std::move(bindings), complaints);
  }
  void take(std::vector<std::uint8_t> message) { mapper->take(message, now_ns); }
  void apply() { mapper->apply(panel, &cues, now_ns); }
  std::vector<Bytes3> feedback() { return mapper->feedback(*panel.values(), now_ns); }
  void set(const std::string& assignment) {
    ASSERT_TRUE(panel.set(std::vector{assignment}, "page"));
  }
  double number(std::string_view path) const {
    return std::strtod(panel.value(path).c_str(), nullptr);
  }
  /// Moves something while a path is learned, and lets the time for it pass.
  void learn(const std::string& path, const std::vector<std::vector<std::uint8_t>>& messages) {
    ASSERT_TRUE(mapper->learn(path, now_ns));
    for (const auto& message : messages) take(message);
    now_ns += 250 * kMs_ns;
    has_learned = mapper->learn_on(now_ns);
  }

  test::TablePanel panel;
  test::RecordedCues cues;
  std::vector<std::string> said;
  Complaints complaints{"midi", [this](const std::string& line) { said.push_back(line); }};
  std::optional<Mapper> mapper;
  std::int64_t now_ns = 1'000'000'000;
  bool has_learned = false;

  void SetUp() override { bind({}); }
};

TEST_F(MidiMapper, AControllerTurnsANumberOverItsRange) {
  bind({{"light.master", Source::controller, 2, 7, {}, {}}});
  take({0xb1, 7, 0});
  apply();
  EXPECT_EQ(panel.value("light.master"), "0");
  take({0xb1, 7, 127});
  apply();
  EXPECT_EQ(panel.value("light.master"), "1");
  EXPECT_EQ(panel.source(), "midi");
  take({0xb0, 7, 0});  // of another channel
  take({0xb1, 8, 0});  // another controller
  apply();
  EXPECT_EQ(panel.value("light.master"), "1");
}

TEST_F(MidiMapper, EndsOfTheFileLimitAKnob) {
  bind({{"light.master", Source::controller, 1, 7, 0.25, 0.75}});
  take({0xb0, 7, 127});
  apply();
  EXPECT_EQ(panel.value("light.master"), "0.75");
}

TEST_F(MidiMapper, FourteenBitsAreFinerThanSeven) {
  bind({{"light.master", Source::controller14, 1, 7, {}, {}}});
  take({0xb0, 7, 64});
  take({0xb0, 39, 1});
  apply();
  EXPECT_NEAR(number("light.master"), (64 * 128 + 1) / 16383.0, 1e-6);
  take({0xb0, 39, 2});
  apply();
  EXPECT_NEAR(number("light.master"), (64 * 128 + 2) / 16383.0, 1e-6);
  EXPECT_THAT(panel.sets, SizeIs(2)) << "the upper and the lower part are one change";
}

TEST_F(MidiMapper, ABendIsFourteenBits) {
  bind({{"projector.brightness", Source::bend, 3, 0, {}, {}}});
  take({0xe2, 0x7f, 0x3f});
  apply();
  EXPECT_NEAR(number("projector.brightness"), 8191 / 16383.0, 1e-6);
}

TEST_F(MidiMapper, WholeNumbersChoicesAndTogglesHaveSteps) {
  bind({{"projector.fill.cells", Source::controller, 1, 1, {}, {}},
        {"cascade.predict.method", Source::controller, 1, 2, {}, {}},
        {"light.freeze", Source::controller, 1, 3, {}, {}}});
  for (const std::uint8_t number : {1, 2, 3}) take({0xb0, number, 64});
  apply();
  EXPECT_EQ(panel.value("projector.fill.cells"), "33");
  EXPECT_EQ(panel.value("cascade.predict.method"), "\"velocity\"");
  EXPECT_EQ(panel.value("light.freeze"), "true");
}

TEST_F(MidiMapper, AKeyTogglesWhenItIsPressed) {
  bind({{"light.blackout", Source::note, 1, 60, {}, {}},
        {"cascade.predict.method", Source::note, 1, 61, {}, {}}});
  take({0x90, 60, 100});
  apply();
  EXPECT_EQ(panel.value("light.blackout"), "true");
  take({0x80, 60, 0});
  apply();
  EXPECT_EQ(panel.value("light.blackout"), "true");
  for (const std::uint8_t velocity : {100, 0, 100, 0}) take({0x90, 60, velocity});
  apply();
  EXPECT_EQ(panel.value("light.blackout"), "true") << "there and back";
  for (const auto* word : {"\"velocity\"", "\"acceleration\"", "\"hold\""}) {
    take({0x90, 61, 1});
    take({0x90, 61, 0});
    apply();
    EXPECT_EQ(panel.value("cascade.predict.method"), word);
  }
}

TEST_F(MidiMapper, KeysAndButtonsGiveCommands) {
  ASSERT_TRUE(panel.store("evening"));
  bind({{"cue.go", Source::note, 1, 1, {}, {}},
        {"cue.back", Source::note, 1, 2, {}, {}},
        {"cue.hold", Source::controller, 1, 3, {}, {}},
        {"cue.jump finale", Source::note, 1, 4, {}, {}},
        {"cue.key g", Source::note, 1, 5, {}, {}},
        {"preset evening", Source::note, 1, 6, {}, {}}});
  for (const std::uint8_t key : {1, 2, 4, 5, 6}) take({0x90, key, 127});
  for (const std::uint8_t place : {0, 127, 127, 0}) take({0xb0, 3, place});
  apply();
  EXPECT_THAT(cues.calls, ElementsAre("go", "back", "jump finale", "key g", "hold"));
  EXPECT_THAT(panel.loads, ElementsAre("evening"));
  apply();
  EXPECT_THAT(cues.calls, SizeIs(5));
}

TEST_F(MidiMapper, AFloodIsOneChange) {
  bind(
      {{"light.master", Source::controller, 1, 7, {}, {}}, {"cue.go", Source::note, 1, 1, {}, {}}});
  for (int i = 0; i < 100'000; ++i) {
    take({0xb0, 7, static_cast<std::uint8_t>(i % 128)});
    take({0x90, 1, 127});
    take({0x90, 1, 0});
  }
  apply();
  EXPECT_THAT(panel.sets, SizeIs(1));
  EXPECT_THAT(cues.calls, SizeIs(32));
}

TEST_F(MidiMapper, BytesThatAreNoMessageAreCounted) {
  bind({{"light.master", Source::controller, 1, 7, {}, {}}});
  for (const auto& message : std::vector<std::vector<std::uint8_t>>{
           {}, {7}, {0xb0}, {0xb0, 7}, {0xb0, 7, 0x80}, {0xb0, 0xff, 1}, {0xb0, 7, 1, 2}})
    take(message);
  EXPECT_EQ(complaints.count(), 7u);
  EXPECT_THAT(said, SizeIs(1)) << "one line a second";
  take({0xf8});        // a clock
  take({0xd0, 1});     // pressure
  take({0xf0, 1, 2});  // the start of a system message
  apply();
  EXPECT_EQ(complaints.count(), 7u);
  EXPECT_THAT(panel.sets, IsEmpty());
}

TEST_F(MidiMapper, TheNextKnobIsLearned) {
  learn("light.master", {{0xb0, 70, 3}, {0xb0, 70, 4}});
  EXPECT_TRUE(has_learned);
  EXPECT_THAT(mapper->bindings(),
              ElementsAre(Binding{"light.master", Source::controller, 1, 70, {}, {}}));
  EXPECT_EQ(mapper->learning(), "");
  take({0xb0, 70, 127});
  apply();
  EXPECT_THAT(panel.sets, SizeIs(1)) << "and what was moved while learning sets nothing";
  EXPECT_FALSE(mapper->learn_on(now_ns)) << "once";
}

TEST_F(MidiMapper, AControllerOfFourteenBitsIsLearnedByEitherHalf) {
  learn("light.master", {{0xb3, 7, 64}, {0xb3, 39, 5}});
  EXPECT_EQ(mapper->bindings()[0], (Binding{"light.master", Source::controller14, 4, 7, {}, {}}));
  learn("projector.brightness", {{0xb3, 40, 64}, {0xb3, 8, 5}});
  EXPECT_EQ(mapper->bindings()[1],
            (Binding{"projector.brightness", Source::controller14, 4, 8, {}, {}}));
  learn("light.freeze", {{0xb3, 41, 64}, {0xb4, 9, 5}});
  EXPECT_EQ(mapper->bindings()[2].source, Source::controller) << "of another channel";
}

TEST_F(MidiMapper, KeysAndBendsAreLearnedAtOnce) {
  learn("cue.go", {{0x90, 60, 0}, {0x80, 61, 64}, {0x90, 62, 100}});
  EXPECT_EQ(mapper->bindings()[0], (Binding{"cue.go", Source::note, 1, 62, {}, {}}));
  learn("light.master", {{0xe5, 0, 64}});
  EXPECT_EQ(mapper->bindings()[1], (Binding{"light.master", Source::bend, 6, 0, {}, {}}));
}

TEST_F(MidiMapper, LearningReplacesWhatWasBound) {
  learn("light.master", {{0xb0, 70, 3}});
  learn("light.master", {{0xb0, 71, 3}});
  learn("projector.brightness", {{0xb0, 71, 3}});
  EXPECT_THAT(mapper->bindings(),
              ElementsAre(Binding{"projector.brightness", Source::controller, 1, 71, {}, {}}));
  mapper->forget("projector.brightness");
  EXPECT_THAT(mapper->bindings(), IsEmpty());
}

TEST_F(MidiMapper, WhatCannotBeTurnedIsRefused) {
  const auto fault_of_learning = [&](std::string_view path) {
    const auto learned = mapper->learn(path, now_ns);
    return learned ? "" : learned.error().what;
  };
  EXPECT_THAT(fault_of_learning("light.mastr"), HasSubstr("did you mean 'light.master'"));
  EXPECT_THAT(fault_of_learning("content.left"), HasSubstr("no knob can turn"));
  EXPECT_THAT(fault_of_learning("cue.jump "), HasSubstr("there is no"));
  EXPECT_EQ(fault_of_learning("cue.jump finale"), "");
  learn("light.master", {{0x90, 60, 100}});
  EXPECT_THAT(said, ElementsAre(HasSubstr("a key cannot turn")));
  EXPECT_THAT(mapper->bindings(), IsEmpty());
}

TEST_F(MidiMapper, LearningEndsByItself) {
  ASSERT_TRUE(mapper->learn("light.master", now_ns));
  EXPECT_FALSE(mapper->learn_on(now_ns + 29'000 * kMs_ns));
  EXPECT_EQ(mapper->learning(), "light.master");
  EXPECT_FALSE(mapper->learn_on(now_ns + 30'000 * kMs_ns));
  EXPECT_EQ(mapper->learning(), "");
  ASSERT_TRUE(mapper->learn("light.master", now_ns));
  mapper->stop_learning();
  take({0xb0, 70, 3});
  EXPECT_FALSE(mapper->learn_on(now_ns + 1000 * kMs_ns));
}

TEST_F(MidiMapper, MotorsAndLampsFollowWhatOthersChange) {
  bind({{"light.master", Source::controller, 1, 7, {}, {}},
        {"projector.brightness", Source::controller14, 1, 8, {}, {}},
        {"projector.fill.cells", Source::bend, 2, 0, {}, {}},
        {"light.blackout", Source::note, 1, 60, {}, {}},
        {"cue.go", Source::note, 1, 61, {}, {}}});
  EXPECT_THAT(feedback(), SizeIs(5)) << "at first, everything";
  EXPECT_THAT(feedback(), IsEmpty());
  set("light.master=0.5");
  EXPECT_THAT(feedback(), ElementsAre(Bytes3{0xb0, 7, 64}));
  set("projector.brightness=0.5");
  EXPECT_THAT(feedback(), ElementsAre(Bytes3{0xb0, 8, 64}, Bytes3{0xb0, 40, 0}));
  set("projector.fill.cells=64");
  EXPECT_THAT(feedback(), ElementsAre(Bytes3{0xe1, 127, 127}));
  set("light.blackout=true");
  EXPECT_THAT(feedback(), ElementsAre(Bytes3{0x90, 60, 127}));
  mapper->forget_shown();
  EXPECT_THAT(feedback(), SizeIs(5)) << "the device was away";
}

TEST_F(MidiMapper, AMotorDoesNotPullAgainstTheHand) {
  bind({{"light.master", Source::bend, 1, 0, {}, {}}});
  (void)feedback();
  take({0xe0, 0x12, 0x34});
  apply();
  now_ns += 400 * kMs_ns;
  EXPECT_THAT(feedback(), IsEmpty()) << "it stands where it was moved to";
  take({0xe0, 0x13, 0x34});
  apply();
  set("light.master=0");
  now_ns += 200 * kMs_ns;
  EXPECT_THAT(feedback(), IsEmpty()) << "it is still held";
  now_ns += 200 * kMs_ns;
  EXPECT_THAT(feedback(), ElementsAre(Bytes3{0xe0, 0, 0}));
}

TEST_F(MidiMapper, FeedbackIsBounded) {
  std::vector<Binding> bindings;
  for (int i = 0; i < 128; ++i)
    bindings.push_back({"light.master", Source::controller, 1, i, {}, {}});
  bind(bindings);
  std::size_t count = 0;
  for (int i = 0; i < 4; ++i) {
    const auto messages = feedback();
    EXPECT_LE(messages.size(), 64u);
    count += messages.size();
  }
  EXPECT_EQ(count, 128u);
}

TEST(MidiBindings, AFileIsReadAsItWasWritten) {
  test::TablePanel panel;
  const std::vector<Binding> bindings{{"light.master", Source::controller14, 16, 31, 0.25, 0.75},
                                      {"cue.jump \"a\"", Source::note, 1, 127, {}, {}},
                                      {"projector.brightness", Source::bend, 3, 0, {}, {}}};
  const auto read = parse_bindings(print_bindings(bindings), "rig.midi.toml", panel.controls());
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(*read, bindings);
  EXPECT_TRUE(parse_bindings("", "rig.midi.toml", panel.controls())->empty());
}

TEST(MidiBindings, AllFaultsAreNamedWithTheirLines) {
  test::TablePanel panel;
  const auto read = parse_bindings(R"(bindings = 1
[[binding]]
path = "light.master"
source = "knob"
channel = 17
number = 7.5
[[binding]]
path = "light.mastr"
[[binding]]
path = "light.master"
source = "controller14"
number = 40
[[binding]]
path = "light.master"
max = 2
[[binding]]
path = "light.master"
nummer = 2
)",
                                   "rig.midi.toml", panel.controls());
  ASSERT_FALSE(read);
  for (const auto* part :
       {":1: it has only bindings", ":4: source must be one of", ":5: channel must be",
        ":6: number must be", ":7: there is no live setting or command 'light.mastr'",
        ":9: number must be 0..31", ":13: light.master: 2 is outside 0..1",
        ":18: there is no 'nummer' (did you mean 'number'?)"})
    EXPECT_THAT(read.error().what, HasSubstr(part));
}

}  // namespace
}  // namespace handcast::desk::midi
