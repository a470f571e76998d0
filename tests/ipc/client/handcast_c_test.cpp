// SPDX-License-Identifier: Apache-2.0
// The interface for other people's programs, as the shared library has it.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>

#include "ipc/base/version.hpp"
#include "ipc/client/handcast.h"
#include "ipc/msg/guest_picture.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/ipc/client/rig_with_rings.hpp"

namespace handcast::client {
namespace {

using ipc::samples::again;
using ipc::samples::must;
using msg::GuestPicture;
using msg::HandPoses;
using testing::HasSubstr;

class HandcastC : public RigWithRings {
 protected:
  void SetUp() override {
    RigWithRings::SetUp();
    give({{"guest.left", left_.fd()}, {"guest.right", right_.fd()}, {"pose.hands", poses_.fd()}});
  }
  void TearDown() override { handcast_close(content_); }

  handcast_result open(int hand = HANDCAST_LEFT, int width = 4, int height = 3,
                       const char* rig = "") {
    const auto [result, sentence] = while_it_turns([=, this] {
      const auto opened = handcast_open(rig, hand, width, height, &content_);
      return std::pair{opened, std::string(handcast_error())};
    });
    sentence_ = sentence;
    return result;
  }
  static ipc::Segment pictures(const char* stream) {
    return must(ipc::Segment::create(
        ipc::RingSpec::of<GuestPicture>(stream, 3, false, GuestPicture::bytes(64, 64))));
  }

  ipc::Segment left_ = pictures("guest.left"), right_ = pictures("guest.right"),
               poses_ =
                   must(ipc::Segment::create(ipc::RingSpec::of<HandPoses>("pose.hands", 8, true)));
  handcast_content* content_ = nullptr;
  std::string sentence_;
};

TEST_F(HandcastC, APictureIsDrawnInTheRingAndShown) {
  ASSERT_EQ(open(HANDCAST_RIGHT), HANDCAST_OK) << sentence_;
  auto reader = must(ipc::Reader<GuestPicture>::watch(again(right_)));
  uint8_t* const pixels = handcast_begin(content_);
  ASSERT_NE(pixels, nullptr) << handcast_error();
  EXPECT_TRUE(std::all_of(pixels, pixels + 48, [](uint8_t level) { return level == 0; }));
  EXPECT_EQ(handcast_begin(content_), pixels) << "the picture that was begun";
  pixels[0] = 1;
  pixels[47] = 4;
  ASSERT_EQ(handcast_set_lasts(content_, 500), HANDCAST_OK);
  ASSERT_EQ(handcast_set_straight(content_, 1), HANDCAST_OK);
  EXPECT_FALSE(reader.latest(Deadline::now())) << "it is not published yet";
  ASSERT_EQ(handcast_publish(content_, 77), HANDCAST_OK);
  const auto shown = must(reader.latest(Deadline::now()));
  EXPECT_EQ(shown->width_px, 4u);
  EXPECT_EQ(shown->height_px, 3u);
  EXPECT_EQ(shown->pixels()[0], 1u);
  EXPECT_EQ(shown->pixels()[11], 0x04000000u);
  EXPECT_EQ(shown->header.origin_ns, 77);
  EXPECT_EQ(shown->header.frame_id, 1u);
  EXPECT_EQ(shown->lasts_ns, 500);
  EXPECT_EQ(shown->is_straight, 1u);
}

TEST_F(HandcastC, TheNextPicturesMayHaveAnotherSize) {
  ASSERT_EQ(open(), HANDCAST_OK) << sentence_;
  auto reader = must(ipc::Reader<GuestPicture>::watch(again(left_)));
  handcast_begin(content_);
  ASSERT_EQ(handcast_size(content_, 8, 8), HANDCAST_OK);
  EXPECT_EQ(handcast_publish(content_, 0), HANDCAST_WRONG_USE) << "that picture was dropped";
  ASSERT_NE(handcast_begin(content_), nullptr);
  ASSERT_EQ(handcast_publish(content_, 0), HANDCAST_OK);
  EXPECT_EQ(must(reader.latest(Deadline::now()))->width_px, 8u);
}

TEST_F(HandcastC, GivesTheHandsOfTheTracker) {
  ASSERT_EQ(open(), HANDCAST_OK) << sentence_;
  handcast_both_hands hands;
  std::fill_n(reinterpret_cast<uint8_t*>(&hands), sizeof hands, 0xff);
  EXPECT_EQ(handcast_hands(content_, &hands), HANDCAST_TIMEOUT);
  EXPECT_EQ(hands.is_there[0], 0);
  EXPECT_EQ(handcast_wait(content_, 0), HANDCAST_TIMEOUT);
  auto writer = must(ipc::Writer<HandPoses>::attach(again(poses_)));
  HandPoses poses;
  poses.header.origin_ns = 123;
  poses.count = 1;
  poses.hands[0].side = msg::Side::right;
  poses.hands[0].joints[10] = {{1, 2, 3}, {0, 1, 0, 0}, 0.5f};
  writer.publish(poses);
  EXPECT_EQ(handcast_wait(content_, 1000), HANDCAST_OK) << handcast_error();
  ASSERT_EQ(handcast_hands(content_, &hands), HANDCAST_OK) << handcast_error();
  EXPECT_EQ(hands.time_ns, 123);
  EXPECT_EQ(hands.is_there[0], 0);
  EXPECT_EQ(hands.is_there[1], 1);
  EXPECT_EQ(hands.joints[1][10].position_m[2], 3);
  EXPECT_EQ(hands.joints[1][10].orientation_xyzw[1], 1);
  EXPECT_EQ(hands.joints[1][10].radius_m, 0.5f);
  EXPECT_EQ(handcast_hands(content_, &hands), HANDCAST_OK) << "the same sample again";
}

TEST_F(HandcastC, WithoutARigTheSentenceSaysHowToStartOne) {
  server_.reset();
  EXPECT_EQ(handcast_open(nullptr, HANDCAST_LEFT, 4, 3, &content_), HANDCAST_UNAVAILABLE);
  EXPECT_THAT(handcast_error(), HasSubstr("handcast up"));
  EXPECT_EQ(content_, nullptr);
}

TEST_F(HandcastC, ASecondProgramOnTheSameHandIsRefusedUntilTheFirstOneLeaves) {
  ASSERT_EQ(open(), HANDCAST_OK) << sentence_;
  auto* const first = content_;
  EXPECT_EQ(open(), HANDCAST_UNAVAILABLE);
  EXPECT_FALSE(sentence_.empty());
  EXPECT_EQ(content_, nullptr);
  handcast_close(first);
  EXPECT_EQ(open(), HANDCAST_OK) << sentence_;
}

TEST_F(HandcastC, ARigWithoutRingsForGuestsIsAnError) {
  give({{"pose.hands", poses_.fd()}});
  EXPECT_EQ(open(), HANDCAST_WRONG_USE);
  EXPECT_THAT(sentence_, HasSubstr("guest.left"));
}

TEST_F(HandcastC, WrongArgumentsAreSentences) {
  EXPECT_EQ(handcast_open("", 2, 4, 3, &content_), HANDCAST_WRONG_USE);
  EXPECT_THAT(handcast_error(), HasSubstr("hand 2"));
  EXPECT_EQ(handcast_open("", 0, 0, 3, &content_), HANDCAST_WRONG_USE);
  EXPECT_THAT(handcast_error(), HasSubstr("0x3"));
  EXPECT_EQ(handcast_open("", 0, 4, HANDCAST_LARGEST + 1, &content_), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_open("", 0, 4, 3, nullptr), HANDCAST_WRONG_USE);
  ASSERT_EQ(open(), HANDCAST_OK) << sentence_;
  EXPECT_EQ(handcast_publish(content_, 0), HANDCAST_WRONG_USE);
  EXPECT_THAT(handcast_error(), HasSubstr("handcast_begin"));
  EXPECT_EQ(handcast_size(content_, -1, 5), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_set_lasts(content_, -1), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_hands(content_, nullptr), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_wait(content_, -1), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_wait(content_, 1 << 30), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_set_straight(content_, 0), HANDCAST_OK);
  EXPECT_STREQ(handcast_error(), "");
}

TEST_F(HandcastC, PointersThatAreNoContentAreErrors) {
  ASSERT_EQ(open(), HANDCAST_OK) << sentence_;
  auto* const closed = content_;
  handcast_close(closed);
  int something = 0;
  handcast_both_hands hands;
  for (auto* const content : {static_cast<handcast_content*>(nullptr), closed,
                              reinterpret_cast<handcast_content*>(&something)}) {
    EXPECT_EQ(handcast_begin(content), nullptr);
    EXPECT_THAT(handcast_error(), HasSubstr("handcast_open()"));
    EXPECT_EQ(handcast_publish(content, 0), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_size(content, 4, 4), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_set_straight(content, 1), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_set_lasts(content, 1), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_hands(content, &hands), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_wait(content, 1), HANDCAST_WRONG_USE);
    handcast_close(content);
  }
  content_ = nullptr;
}

TEST_F(HandcastC, APictureLargerThanTheRingIsRefused) {
  ASSERT_EQ(open(HANDCAST_LEFT, 1000, 1000), HANDCAST_BAD_DATA);  // this test's rings are small
  EXPECT_EQ(content_, nullptr);
}

TEST_F(HandcastC, TheVersionIsThatOfTheBuild) { EXPECT_EQ(handcast_version(), version()); }

}  // namespace
}  // namespace handcast::client
