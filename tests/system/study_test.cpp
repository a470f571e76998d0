// SPDX-License-Identifier: Apache-2.0
// Games beside a rig.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/display_server.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// True if a frame lights a hand, at least as the night sky of the shooter does.
bool is_lit(const msg::Projection& frame) {
  const std::size_t count = std::size_t{frame.region_width_px} * frame.region_height_px;
  return std::any_of(frame.pixels(), frame.pixels() + count, [](auto pixel) {
    return (pixel & 0xff) > 30 || (pixel >> 8 & 0xff) > 30 || (pixel >> 16 & 0xff) > 30;
  });
}

/// Counts the frames of the rig in which a hand is there and not lit. Those in which it comes or
/// goes do not count: where the tracker is late on a busy computer, the light fades.
class DarkFrames {
 public:
  explicit DarkFrames(const std::filesystem::path& scope)
      : scope_(control::kScopeVariable, scope.string()),
        frames_(client::open_stream<msg::Projection>("twin", "projection.frames")) {}
  bool is_open() const { return frames_.has_value(); }
  void watch(std::chrono::milliseconds time) {
    for (const auto end = Deadline::in(time); !end.passed();) {
      const auto frame = frames_->next(Deadline::in(100ms));
      if (!frame || (*frame)->hand_count == 0 || (*frame)->hands[0].presence < 1) continue;
      ++seen_;
      dark_ += !is_lit(**frame);
    }
  }
  int seen() const { return seen_; }
  int dark() const { return dark_; }

 private:
  Variable scope_;
  Result<client::Stream<msg::Projection>> frames_;
  int seen_ = 0, dark_ = 0;
};

class RigWithAGame : public SystemTest {
 protected:
  std::string shown(const char* hand = "left") const {
    return nlohmann::json::parse(handcast({"content", "--json"}).output)[hand]["content"];
  }
};

TEST_F(RigWithAGame, AGameThatIsKilledLeavesNoDarkFrameAndOneThatEndsGivesTheHandBack) {
  const auto rig =
      up({"--set", "content.left=builtin:white", "--set", "twin.motion=builtin:still"});
  wait_until_light();
  DarkFrames frames(scratch_.path());
  ASSERT_TRUE(frames.is_open());
  for (int time = 0; time < 6; ++time) {
    Command game(scratch_.path(), {"study", "shooter"});
    frames.watch(1500ms);
    game.signal(SIGKILL);
    game.wait();
    frames.watch(300ms);
    EXPECT_TRUE(eventually([&] { return shown() == "program:"; })) << shown();
  }
  EXPECT_GT(frames.seen(), 100);
  EXPECT_EQ(frames.dark(), 0);

  ASSERT_EQ(handcast({"content", "builtin:checker"}).exit_code, 0);
  Command game(scratch_.path(), {"study", "shooter"});
  ASSERT_TRUE(eventually([&] { return shown() == "program:"; })) << game.log();
  game.signal(SIGTERM);
  EXPECT_EQ(game.wait(), 0);
  EXPECT_THAT(game.output(), HasSubstr("Best score"));
  EXPECT_TRUE(eventually([&] { return shown() == "builtin:checker"; })) << shown();
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithAGame, AGameOnTwoHandsIsShownOnBothAndGivesBothBack) {
  const auto rig = up({"--set", "content.left=builtin:white", "--set",
                       "content.right=builtin:skeleton", "--set", "twin.motion=builtin:two_hands"});
  wait_until_light();
  Command game(scratch_.path(), {"study", "shooter", "--two-hands"});
  for (const auto* hand : {"left", "right"})
    EXPECT_TRUE(eventually([&] { return shown(hand) == "program:"; })) << hand << game.log();
  game.signal(SIGTERM);
  EXPECT_EQ(game.wait(), 0);
  EXPECT_TRUE(eventually([&] { return shown("left") == "builtin:white"; })) << shown("left");
  EXPECT_TRUE(eventually([&] { return shown("right") == "builtin:skeleton"; })) << shown("right");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

// Each is killed at another moment of its first 1.5 s: while it starts, while the rig turns to it,
// while it draws.
TEST_F(RigWithAGame, AnyProgramThatIsKilledAHundredTimesLeavesNoDarkFrame) {
  const test::DisplayServer display;  // for the study on a screen
  const auto rig =
      up({"--set", "content.left=builtin:white", "--set", "twin.motion=builtin:still"});
  wait_until_light();
  const auto folder = (scratch_.path() / "study").string();
  const std::vector<std::vector<std::string>> programs{
      {"study", "shooter", "--two-hands"},
      {"study", "character", folder},
      {"study", "pose", folder},
      {"study", "jnd", folder, "--answers-by-model", "--window", "--size", "320x240"}};
  for (const auto& program : programs) {
    DarkFrames frames(scratch_.path());
    ASSERT_TRUE(frames.is_open());
    for (int time = 0; time < 100; ++time) {
      Command game(scratch_.path(), program);
      frames.watch(std::chrono::milliseconds(50 + 37 * time % 1450));
      game.signal(SIGKILL);
      game.wait();
      frames.watch(150ms);
    }
    fmt::print("{}: {} frames with a hand, {} dark\n", program[1], frames.seen(), frames.dark());
    EXPECT_GT(frames.seen(), 1000) << program[1];
    EXPECT_EQ(frames.dark(), 0) << program[1];
  }
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

TEST_F(RigWithAGame, ASessionOfTheCharacterStudySwitchesTheCorrectionsAndBack) {
  const auto rig = up({"--set", "twin.motion=builtin:count"});
  wait_until_light();
  const auto folder = (scratch_.path() / "study").string();
  Command study(scratch_.path(), {"study", "character", folder, "--rounds", "1", "--sessions", "2",
                                  "--difficulty", "2"});
  ASSERT_TRUE(eventually([&] {
    return handcast({"get", "cascade.correct.method"}).output.find("none") != std::string::npos;
  })) << study.log();
  ASSERT_TRUE(eventually([&] {
    return study.output().find("Session 3 of 6") != std::string::npos;
  })) << study.output()
      << study.log();
  study.signal(SIGINT);
  EXPECT_NE(study.wait(), 0);
  EXPECT_TRUE(eventually([&] { return handcast({"get", "--changed"}).output.empty(); }));
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  const auto without = handcast({"study", "shooter"});
  EXPECT_NE(without.exit_code, 0);
  EXPECT_THAT(without.log, HasSubstr("no rig"));
}

}  // namespace
}  // namespace handcast::system_test
