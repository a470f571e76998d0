// SPDX-License-Identifier: Apache-2.0
#include "services/desk/rig_panel.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

namespace handcast::desk {
namespace {

using testing::HasSubstr;

/// A panel, and the board of another program.
class RigPanelTest : public testing::Test {
 protected:
  config::LiveBoard board() const {
    config::Rig filed;
    filed.projector.brightness = 0.75;
    return {*ipc::Segment::open(UniqueFd(::dup(ring_.fd()))), filed, "/nowhere/show.toml"};
  }
  std::string value(std::string_view path) const {
    return panel_.values()->toml[*find_control(panel_.controls(), path)];
  }
  Result<void> set(const std::string& assignment) {
    const std::vector<std::string> all{assignment};
    return panel_.set(all, "test");
  }

  ipc::Segment ring_ =
      *ipc::Segment::create(ipc::RingSpec::of<msg::LiveSettings>("live.settings", 8, false));
  RigPanel panel_{board()};
};

TEST_F(RigPanelTest, ControlsSayWhatTheyAre) {
  const auto& brightness =
      panel_.controls()[*find_control(panel_.controls(), "projector.brightness")];
  EXPECT_EQ(brightness.kind, Kind::number);
  EXPECT_EQ(brightness.initial, "1");
  EXPECT_EQ(brightness.filed, "0.75");
  EXPECT_EQ(brightness.range.max, 1);
  const auto& method = panel_.controls()[*find_control(panel_.controls(), "cascade.fill.method")];
  EXPECT_EQ(method.kind, Kind::choice);
  EXPECT_GT(method.words.size(), 1u);
  const auto& areas = panel_.controls()[*find_control(panel_.controls(), "light.keep_out")];
  EXPECT_EQ(areas.kind, Kind::texts);
  EXPECT_FALSE(find_control(panel_.controls(), "camera.backend"));
}

TEST_F(RigPanelTest, ValuesFollowEveryProgram) {
  EXPECT_EQ(value("projector.brightness"), "0.75");
  ASSERT_TRUE(set("projector.brightness=0.5"));
  EXPECT_EQ(value("projector.brightness"), "0.5");
  EXPECT_EQ(panel_.values()->source, "test");
  const std::vector<std::string> change{"projector.brightness=0.25"};
  ASSERT_TRUE(board().set(change, "other"));
  EXPECT_EQ(value("projector.brightness"), "0.25");
  EXPECT_EQ(panel_.values()->source, "other");
  const auto same = panel_.values();
  EXPECT_EQ(panel_.values(), same) << "nothing has changed";
  ASSERT_TRUE(panel_.undo("test"));
  EXPECT_TRUE(panel_.values()->can_redo);
}

TEST_F(RigPanelTest, ContentIsForOneHandOrBoth) {
  ASSERT_TRUE(panel_.show("left", "builtin:white", "test"));
  EXPECT_EQ(value("content.left"), "\"builtin:white\"");
  EXPECT_EQ(value("content.right"), "\"builtin:atlas\"");
  EXPECT_THAT(panel_.show("third", "builtin:white", "test").error().what, HasSubstr("is no hand"));
}

}  // namespace
}  // namespace handcast::desk
