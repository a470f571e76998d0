// SPDX-License-Identifier: Apache-2.0
#include "config/live/live_board.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "config/live_files.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/scratch.hpp"

namespace handcast::config {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

/// The ring of a rig, and a rig file beside which presets are kept.
class LiveBoardTest : public testing::Test {
 protected:
  ipc::Segment ring() const { return *ipc::Segment::open(UniqueFd(::dup(ring_.fd()))); }
  LiveBoard board() const { return {ring(), *load_rig(file()), file()}; }
  std::filesystem::path file() const { return scratch_.path() / "show.toml"; }
  void SetUp() override { std::ofstream(file()) << "projector.brightness = 0.75\n"; }

  static std::string values(const LiveBoard& board) {
    const auto now = board.now();
    return now ? std::string(now->values.view()) : now.error().what;
  }
  static bool set(LiveBoard& board, const std::string& assignment) {
    const std::vector<std::string> all{assignment};
    return board.set(all, "test").has_value();
  }

  test::Scratch scratch_;
  ipc::Segment ring_ =
      *ipc::Segment::create(ipc::RingSpec::of<msg::LiveSettings>("live.settings", 8, false));
};

TEST_F(LiveBoardTest, ProgramsSeeEachOthersChanges) {
  auto one = board(), other = board();
  EXPECT_EQ(values(one), "");
  ASSERT_TRUE(set(one, "projector.brightness=0.5"));
  ASSERT_TRUE(set(other, "light.freeze=true"));
  EXPECT_EQ(values(one), "projector.brightness = 0.5\nlight.freeze = true\n");
  ASSERT_TRUE(one.undo("test"));
  ASSERT_TRUE(other.undo("test"));
  EXPECT_EQ(values(one), "");
  EXPECT_EQ(other.undo("test").error().code, Errc::bad_config);
}

TEST_F(LiveBoardTest, NoChangeOfManyProgramsIsLost) {
  constexpr int kChanges = 50;
  const auto change = [&](const char* path) {
    auto mine = board();
    for (int i = 1; i <= kChanges; ++i)
      ASSERT_TRUE(set(mine, fmt::format("{}={}", path, 0.001 * i)));
  };
  std::thread some(change, "light.master"), others(change, "content.shading");
  some.join();
  others.join();
  EXPECT_EQ(board().now()->header.frame_id, 2u * kChanges);
  EXPECT_EQ(values(board()), "content.shading = 0.05\nlight.master = 0.05\n");
}

TEST_F(LiveBoardTest, AProgramThatHoldsTheRingIsNamedAfterTwoSeconds) {
  const auto held = ipc::Writer<msg::LiveSettings>::attach(ring());
  ASSERT_TRUE(held);
  auto mine = board();
  const std::vector<std::string> change{"light.blackout=true"};
  const auto refused = mine.set(change, "test");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unavailable);
}

TEST_F(LiveBoardTest, WhatIsSavedIsThereAfterTheNextStartAndInTheNextSave) {
  auto first = board();
  ASSERT_TRUE(set(first, "light.master=0.5"));
  ASSERT_TRUE(first.save());
  EXPECT_EQ(load_rig(file())->light.master, 0.5);
  EXPECT_EQ(load_rig(file())->projector.brightness, 0.75);

  ring_ = *ipc::Segment::create(ipc::RingSpec::of<msg::LiveSettings>("live.settings", 8, false));
  auto next = board();
  ASSERT_TRUE(set(next, "content.shading=0.25"));
  ASSERT_TRUE(next.save());
  EXPECT_EQ(load_rig(file())->light.master, 0.5);
  EXPECT_EQ(load_rig(file())->content.shading, 0.25);
}

TEST_F(LiveBoardTest, PresetsReplaceAllLiveValues) {
  auto mine = board();
  ASSERT_TRUE(set(mine, "light.master=0.5"));
  ASSERT_TRUE(mine.store("dim"));
  ASSERT_TRUE(set(mine, "light.master"));
  ASSERT_TRUE(set(mine, "light.freeze=true"));
  ASSERT_TRUE(mine.load("dim", "test"));
  EXPECT_EQ(values(mine), "light.master = 0.5\n");
  ASSERT_TRUE(mine.undo("test"));
  EXPECT_EQ(values(mine), "light.freeze = true\n");
  EXPECT_THAT(preset_names(file()), ElementsAre("dim"));
  EXPECT_THAT(mine.load("bright", "test").error().what, HasSubstr("there are: dim"));
  EXPECT_THAT(mine.store("../dim").error().what, HasSubstr("cannot be the name of a preset"));
}

TEST_F(LiveBoardTest, APresetThatSomebodySpoiledChangesNothing) {
  auto mine = board();
  ASSERT_TRUE(mine.store("dim"));
  std::ofstream(*preset_file_of(file(), "dim")) << "light.master = 7\n";
  const auto refused = mine.load("dim", "test");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("dim.toml:1: light.master: 7 is outside 0..1"));
  EXPECT_EQ(values(mine), "");
}

}  // namespace
}  // namespace handcast::config
