// SPDX-License-Identifier: Apache-2.0
// What is started from the page, and what it is told of recordings, cues, calibration and MIDI.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "calib/calibration.hpp"
#include "services/desk/page/errand.hpp"
#include "services/desk/page/facts.hpp"
#include "services/desk/page/programs.hpp"
#include "services/recording/about.hpp"
#include "services/recording/index_row.hpp"
#include "tests/services/desk/page/open_page.hpp"

namespace handcast::test {
namespace {

using control::Role;
using nlohmann::json;
using testing::HasSubstr;
using namespace std::chrono_literals;

/// Waits for the end of a program.
desk::Errand::State ended(const desk::Errand& errand) {
  auto state = errand.state();
  for (const auto until = Deadline::in(20s); state.is_running && !until.passed();) {
    sleep_until_ns(now_ns() + 5'000'000);
    state = errand.state();
  }
  return state;
}

/// Waits until a program has written something.
std::string output_of(const desk::Errand& errand) {
  for (const auto until = Deadline::in(20s); errand.state().output.empty() && !until.passed();)
    sleep_until_ns(now_ns() + 5'000'000);
  return errand.state().output;
}

bool is_alive(const std::string& pid) {
  std::ifstream status("/proc/" + pid + "/stat");
  std::string number, name, state;
  return status >> number >> name >> state && state != "Z";
}

TEST(Errand, AProgramSaysWhatItSaysAndHowItEnded) {
  desk::Errand errand(60s);
  ASSERT_TRUE(errand.start({"/bin/sh", "-c", "echo out; echo log >&2; exit 3"}));
  const auto state = ended(errand);
  EXPECT_EQ(state.output, "out\n");
  EXPECT_EQ(state.log, "log\n");
  EXPECT_EQ(state.exit_code, 3);
  EXPECT_FALSE(errand.stop());
}

TEST(Errand, OneRunsAtATimeUntilItIsStopped) {
  desk::Errand errand(60s);
  ASSERT_TRUE(errand.start({"/bin/sleep", "1000"}));
  EXPECT_FALSE(errand.start({"/bin/true"}));
  EXPECT_TRUE(errand.stop());
  EXPECT_EQ(ended(errand).exit_code, -1);
  ASSERT_TRUE(errand.start({"/bin/true"}));
  EXPECT_EQ(ended(errand).exit_code, 0);
}

TEST(Errand, ItEndsWithTheDeskAndWithAllThatItHasStarted) {
  std::string pids;
  {
    desk::Errand errand(60s);
    ASSERT_TRUE(errand.start({"/bin/sh", "-c", "sleep 1000 & echo $$ $!; wait"}));
    pids = output_of(errand);
  }
  const auto space = pids.find(' ');
  ASSERT_NE(space, pids.npos);
  EXPECT_FALSE(is_alive(pids.substr(0, space)));
  EXPECT_FALSE(is_alive(pids.substr(space + 1, pids.size() - space - 2)));
}

TEST(Errand, WhatRunsForTooLongIsStopped) {
  desk::Errand errand(0s);
  ASSERT_TRUE(errand.start({"/bin/sleep", "1000"}));
  EXPECT_FALSE(ended(errand).is_running);
}

TEST(Errand, WhatIsWrittenWithoutEndIsCutOff) {
  desk::Errand errand(60s);
  ASSERT_TRUE(errand.start({"/bin/sh", "-c", "head -c 4000000 /dev/zero"}));
  const auto state = ended(errand);
  EXPECT_EQ(state.exit_code, 0);
  EXPECT_EQ(state.output.size(), desk::Errand::kMostBytes);
}

TEST(Errand, AProgramThatIsNotThereIsASentence) {
  desk::Errand errand(60s);
  ASSERT_TRUE(errand.start({"/no/such/program"}));
  EXPECT_EQ(ended(errand).log, "/no/such/program cannot be started\n");
}

/// The files of a recording, as far as they are read.
void write_recording(const std::filesystem::path& folder, std::int64_t seconds) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / recording::kAboutFile) << recording::about_text("table", {"pose.hands"});
  std::ofstream index(folder / "pose.hands.index", std::ios::binary);
  for (const std::int64_t at_s : {std::int64_t{100}, 100 + seconds}) {
    recording::IndexRow row;
    row.published_ns = at_s * 1'000'000'000;
    index.write(reinterpret_cast<const char*>(&row), sizeof row);
  }
  index << "a row that was cut off";
}

TEST(Recordings, TheyHaveALengthAndASize) {
  const Scratch scratch;
  write_recording(scratch.path() / "first", 42);
  std::filesystem::create_directory(scratch.path() / "none");
  std::ofstream(scratch.path() / "file") << "x";
  const auto all = desk::recordings_in(scratch.path());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].name, "first");
  EXPECT_EQ(all[0].seconds, 42);
  EXPECT_GT(all[0].bytes, 2 * sizeof(recording::IndexRow));
  EXPECT_TRUE(desk::recordings_in(scratch.path() / "nowhere").empty());
}

TEST(CueFacts, CuesAreToldInWords) {
  const Scratch scratch;
  const TablePanel panel;
  const auto file = scratch.path() / "evening.toml";
  std::ofstream(file) << R"(
[[cue]]
on = ["key d", "at 20:15", "at 08:05:09", "left.appears", "idle 30", "after 5"]
fade_s = 3
both = "builtin:white"
transition = "cut"
set.light.master = 0
set.content.gravity = [1, 0, 0]
set.projector.brightness = { to = 0.5, fade_s = 0.5, curve = "s-curve" }
set.light.freeze = true
set.projector.fill.cells = 4
)";
  const auto facts = json::parse(desk::cue_facts(file, panel.controls()));
  ASSERT_EQ(facts.size(), 1u);
  EXPECT_EQ(
      facts[0]["on"],
      "key d, at 20:15, at 8:05:09, left.appears, no hand for 30 s, 5 s after the one before");
  const std::string does = facts[0]["does"];
  EXPECT_THAT(does, HasSubstr("both: builtin:white"));
  EXPECT_THAT(does, HasSubstr("content.transition → cut"));
  EXPECT_THAT(does, HasSubstr("3 more"));
  EXPECT_EQ(desk::cue_facts("", panel.controls()), "[]");
  EXPECT_EQ(desk::cue_facts(scratch.path() / "none.toml", panel.controls()), "[]");
}

TEST(CalibrationFacts, EachStepSaysWhenItWasMeasuredAndHow) {
  const Scratch scratch;
  const auto rig_file = scratch.path() / "a.toml";
  std::ofstream(scratch.path() / "a.measured.toml") << "projector.latency_ms = 10.5\n";
  config::Rig rig;
  rig.calibration = scratch.path() / "c.toml";
  auto calibration = calib::reference_rig();
  calibration.made.lens = "2026-11-02: 0.1 px over 20 views";
  std::ofstream(rig.calibration) << calib::print_calibration(calibration);
  const auto facts = json::parse(desk::calibration_facts(rig, rig_file, calibration));
  EXPECT_EQ(facts["age_days"], 0);
  ASSERT_EQ(facts["steps"].size(), 4u) << "one camera";
  EXPECT_EQ(facts["steps"][0]["made"], "2026-11-02: 0.1 px over 20 views");
  EXPECT_EQ(facts["steps"][0]["command"], "handcast calibrate " + rig_file.string() + " lens");
  EXPECT_EQ(facts["steps"][1]["made"], "");
  EXPECT_EQ(facts["steps"][3]["made"], "after 10.5 ms");
}

TEST(LookPictures, NothingButPicturesOfLooksIsSent) {
  const Scratch scratch;
  std::filesystem::create_directory(scratch.path() / "looks");
  std::ofstream(scratch.path() / "looks" / "fire.fs") << "void main() {}";
  std::ofstream(scratch.path() / "looks" / "fire.png") << "a picture";
  std::ofstream(scratch.path() / "secret.png") << "another";
  ::setenv("HANDCAST_ASSETS", scratch.path().c_str(), 1);
  EXPECT_EQ(desk::picture_of_look("fire"), "a picture");
  for (const auto* name : {"", "none", "../secret", "/etc/passwd", "fire.fs", ".", ".."})
    EXPECT_EQ(desk::picture_of_look(name), std::nullopt) << name;
  EXPECT_EQ(desk::looks(), (json{{{"name", "fire"}, {"picture", true}}}));
  ::unsetenv("HANDCAST_ASSETS");
}

TEST_F(PageTest, OnlyTheOwnerStartsPrograms) {
  for (const auto* path : {"/api/record/start", "/api/record/stop", "/api/doctor",
                           "/api/midi/learn", "/api/midi/forget", "/api/midi/stop"}) {
    EXPECT_EQ(post(path, R"({"name":"a","path":"light.master"})", Role::operator_).status, 403);
    EXPECT_EQ(ask(port_, "GET", path, as(Role::owner)).status, 405) << path;
  }
  EXPECT_EQ(midi_.state().learning, "");
  EXPECT_FALSE(std::filesystem::exists(scratch_.path() / "recordings"));
}

TEST_F(PageTest, ARecordingHasANameThatIsOneFolder) {
  for (const auto* name : {"..", "../a", "/tmp/a", "-a", ".a", "a b", "a\\u0000", "ä"})
    EXPECT_EQ(
        post("/api/record/start", fmt::format(R"({{"name":"{}"}})", name), Role::owner).status, 422)
        << name;
  EXPECT_EQ(post("/api/record/start", "{}", Role::owner).status, 400);
  write_recording(scratch_.path() / "recordings" / "first", 7);
  EXPECT_EQ(post("/api/record/start", R"({"name":"first"})", Role::owner).status, 422);
  EXPECT_EQ(post("/api/record/stop", "{}", Role::owner).status, 422);
  const auto events = stream("/api/events", Role::viewer, "event: recordings");
  EXPECT_THAT(events->receive("\"name\":\"first\""), HasSubstr("\"seconds\":7.0"));
}

TEST_F(PageTest, ARecordingThatFailsSaysWhy) {
  const auto events = stream("/api/events", Role::viewer, "event: recordings");
  EXPECT_EQ(post("/api/record/start", R"({"name":"a"})", Role::owner).status, 200);
  EXPECT_THAT(events->receive("\"fault\":\"/", 0, std::chrono::seconds(1)) +
                  events->receive("\"fault\":\"h"),
              testing::ContainsRegex("\"fault\":\"[^\"]"));
}

TEST_F(PageTest, KnobsAreLearnedAndForgotten) {
  const auto events = stream("/api/events", Role::viewer, "event: midi");
  EXPECT_EQ(post("/api/midi/learn", R"({"path":"light.master"})", Role::owner).status, 200);
  EXPECT_THAT(events->receive("\"learning\":\"light.master\""), HasSubstr("light.master"));
  midi_.bind();
  EXPECT_THAT(events->receive("\"path\":\"light.master\""), HasSubstr("controller 7 of channel 1"));
  EXPECT_EQ(post("/api/midi/forget", R"({"path":"light.master"})", Role::owner).status, 200);
  EXPECT_TRUE(midi_.state().bindings.empty());
  EXPECT_EQ(post("/api/midi/learn", R"({"path":"no.such"})", Role::owner).status, 422);
  EXPECT_EQ(post("/api/midi/learn", "{}", Role::owner).status, 400);
}

}  // namespace
}  // namespace handcast::test
