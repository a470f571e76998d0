// SPDX-License-Identifier: Apache-2.0
#include "services/content/contents.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "ipc/base/clock.hpp"
#include "tests/services/content/made_hand.hpp"

namespace handcast::content {
namespace {

using testing::HasSubstr;

template <class T>
ipc::Segment ring(const std::string& stream, std::size_t bytes = sizeof(T)) {
  return *ipc::Segment::create(ipc::RingSpec::of<T>(stream, 16, true, bytes));
}
ipc::Segment again(const ipc::Segment& segment) {
  return *ipc::Segment::open(UniqueFd(::dup(segment.fd())));
}
template <class T>
ipc::Reader<T> reader(const ipc::Segment& segment) {
  return *ipc::Reader<T>::attach(again(segment), ipc::Wait::futex);
}
template <class T>
ipc::Writer<T> writer(const ipc::Segment& segment) {
  return *ipc::Writer<T>::attach(again(segment));
}

/// The contents of two hands between rings of their own.
class ContentsTest : public testing::Test {
 protected:
  Contents contents() const {
    return {hands(),
            settings_,
            calibration_,
            {.poses = reader<msg::HandPoses>(poses_),
             .commands = reader<msg::ContentCommand>(commands_),
             .images = reader<msg::CameraFrame>(images_),
             .states = writer<msg::ContentState>(states_),
             .pictures = {writer<msg::ContentPicture>(left_), writer<msg::ContentPicture>(right_)}},
            {},
            [](const Error& error) { ADD_FAILURE() << error.what; }};
  }
  static Hands hands() { return *Hands::load(*config::parse_rig("", ""), calib::reference_rig()); }
  void command(std::uint64_t number, const std::string& content, std::uint32_t hands = 0b11) {
    msg::ContentCommand command;
    command.header.frame_id = number;
    command.hands = hands;
    command.content.set(content);
    asked_.publish(command);
  }
  /// What was told last of the left hand.
  const msg::ShownContent& left() {
    if (const auto told = told_.latest(Deadline::now())) last_ = (*told)->hands[0];
    return last_;
  }

  config::Content settings_ = [] {
    config::Content settings;
    settings.width_px = settings.height_px = 128;
    return settings;
  }();
  const calib::Calibration calibration_ = calib::reference_rig();
  const ipc::Segment poses_ = ring<msg::HandPoses>("poses"),
                     commands_ = ring<msg::ContentCommand>("commands"),
                     images_ = ring<msg::CameraFrame>("images"),
                     states_ = ring<msg::ContentState>("states"),
                     left_ =
                         ring<msg::ContentPicture>("left", msg::ContentPicture::bytes(128, 128)),
                     right_ =
                         ring<msg::ContentPicture>("right", msg::ContentPicture::bytes(128, 128));
  ipc::Writer<msg::ContentCommand> asked_ = writer<msg::ContentCommand>(commands_);
  ipc::Reader<msg::ContentState> told_ = reader<msg::ContentState>(states_);
  msg::ShownContent last_;
};

TEST_F(ContentsTest, ACommandThatANewerOneReplacesIsPassedOver) {
  auto contents = this->contents();
  contents.start({});
  command(1, "nowhere.png", 0b01);
  command(2, "builtin:white");
  EXPECT_TRUE(contents.obey_until(now_ns()));
  EXPECT_FALSE(contents.obey_until(now_ns()));
  contents.publish_state();
  EXPECT_EQ(left().command, 2u);
  EXPECT_EQ(left().fault.view(), "");
  EXPECT_EQ(left().content.view(), "builtin:white");
}

TEST_F(ContentsTest, WhatIsBegunIsToldBeforeAndTriedUntilItHasDrawn) {
  auto contents = this->contents();
  contents.start({});
  contents.draw(now_ns());
  command(1, "builtin:checker", 0b01);
  contents.obey_until(now_ns());
  EXPECT_EQ(left().trying.view(), "builtin:checker");
  EXPECT_EQ(left().content.view(), "builtin:atlas");
  contents.draw(now_ns());
  contents.publish_state();
  EXPECT_EQ(left().trying.view(), "");
  EXPECT_EQ(left().content.view(), "builtin:checker");
}

TEST_F(ContentsTest, WhatAProcessDiedWithIsRefusedUntilItIsAskedForAgainAndItsContentGoesOn) {
  command(1, "builtin:checker");
  msg::ContentState before;
  before.hands[0].content.set("builtin:joints");
  before.hands[0].trying.set("builtin:checker");
  auto contents = this->contents();
  contents.start(before);
  contents.publish_state();
  EXPECT_EQ(left().content.view(), "builtin:joints");
  EXPECT_THAT(std::string(left().fault.view()), HasSubstr("died with its first picture"));
  command(2, "builtin:checker");
  contents.obey_until(now_ns());
  contents.publish_state();
  EXPECT_EQ(left().content.view(), "builtin:checker");
  EXPECT_EQ(left().fault.view(), "");
}

TEST_F(ContentsTest, ASettingThatCannotBeShownIsNamedUnlessItIsKnown) {
  settings_.right = "nowhere.png";
  const auto checked = check_contents(hands(), settings_, calibration_);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().what, HasSubstr("content.right: nowhere.png"));
  msg::ContentState known;
  known.hands[1].settings.set("nowhere.png");
  EXPECT_TRUE(check_contents(hands(), settings_, calibration_, known));
}

}  // namespace
}  // namespace handcast::content
