// SPDX-License-Identifier: Apache-2.0
#include "services/content/contents.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "config/live/live_values.hpp"
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
  Contents contents() {
    return {hands(),
            filed(),
            calibration_,
            {.poses = reader<msg::HandPoses>(poses_),
             .live = reader<msg::LiveSettings>(live_),
             .images = reader<msg::CameraFrame>(images_),
             .states = writer<msg::ContentState>(states_),
             .pictures = {writer<msg::ContentPicture>(left_), writer<msg::ContentPicture>(right_)}},
            {},
            [](const Error& error) { ADD_FAILURE() << error.what; },
            [this] { ++beats_; }};
  }
  static Hands hands() { return *Hands::load(*config::parse_rig("", ""), calib::reference_rig()); }
  config::Rig filed() const {
    config::Rig rig;
    rig.content = settings_;
    return rig;
  }
  /// Asks for content as `handcast content` does.
  void ask(std::uint64_t number, const std::vector<std::string>& changes) {
    const auto values = config::changed_values(filed(), asked_.values.view(), changes);
    ASSERT_TRUE(values) << values.error().what;
    asked_.header.frame_id = number;
    asked_.values.set(*values);
    asked_.change.set(changes.front());
    asks_.publish(asked_);
  }
  /// What was told last of the left hand.
  const msg::ShownContent& left() {
    if (const auto told = told_.latest(Deadline::now())) last_ = (*told)->hands[0];
    return last_;
  }

  int beats_ = 0;
  config::Content settings_ = [] {
    config::Content settings;
    settings.width_px = settings.height_px = 128;
    return settings;
  }();
  const calib::Calibration calibration_ = calib::reference_rig();
  const ipc::Segment poses_ = ring<msg::HandPoses>("poses"),
                     live_ = ring<msg::LiveSettings>("live"),
                     images_ = ring<msg::CameraFrame>("images"),
                     states_ = ring<msg::ContentState>("states"),
                     left_ =
                         ring<msg::ContentPicture>("left", msg::ContentPicture::bytes(128, 128)),
                     right_ =
                         ring<msg::ContentPicture>("right", msg::ContentPicture::bytes(128, 128));
  ipc::Writer<msg::LiveSettings> asks_ = writer<msg::LiveSettings>(live_);
  msg::LiveSettings asked_;
  ipc::Reader<msg::ContentState> told_ = reader<msg::ContentState>(states_);
  msg::ShownContent last_;
};

TEST_F(ContentsTest, AChangeThatANewerOneFollowsIsPassedOver) {
  auto contents = this->contents();
  contents.start({});
  ask(1, {"content.left=film:nowhere.mp4"});
  ask(2, {"content.left=builtin:white"});
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
  ask(1, {"content.left=builtin:checker"});
  contents.obey_until(now_ns());
  EXPECT_EQ(left().trying.view(), "builtin:checker");
  EXPECT_EQ(left().content.view(), "builtin:atlas");
  contents.draw(now_ns());
  contents.publish_state();
  EXPECT_EQ(left().trying.view(), "");
  EXPECT_EQ(left().content.view(), "builtin:checker");
}

TEST_F(ContentsTest, ItGivesASignOfLifeAfterEachHandThatTakesItsTime) {
  auto contents = this->contents();
  contents.start({});
  ask(1, {"content.left=builtin:checker", "content.right=builtin:joints"});
  contents.obey_until(now_ns());
  EXPECT_EQ(beats_, 2);
  contents.draw(now_ns());
  EXPECT_EQ(beats_, 4);
}

TEST_F(ContentsTest, WhatAProcessDiedWithIsRefusedUntilItIsAskedForAgainAndItsContentGoesOn) {
  ask(1, {"content.left=builtin:checker"});
  msg::ContentState before;
  before.hands[0].content.set("builtin:joints");
  before.hands[0].trying.set("builtin:checker");
  auto contents = this->contents();
  contents.start(before);
  contents.publish_state();
  EXPECT_EQ(left().content.view(), "builtin:joints");
  EXPECT_THAT(std::string(left().fault.view()), HasSubstr("died with its first picture"));
  ask(2, {"content.left=builtin:checker"});
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
