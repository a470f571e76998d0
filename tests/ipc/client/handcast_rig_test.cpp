// SPDX-License-Identifier: Apache-2.0
// Reading the sensors of a rig and taking their place, as the shared library does it.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <limits>

#include "ipc/base/clock.hpp"
#include "ipc/client/handcast.h"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "ipc/msg/landmarks.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"
#include "tests/ipc/client/rig_with_rings.hpp"

namespace handcast::client {
namespace {

using ipc::samples::again;
using ipc::samples::must;
using testing::HasSubstr;

class HandcastRig : public RigWithRings {
 protected:
  void SetUp() override {
    RigWithRings::SetUp();
    give({{"camera.frames", images_.fd()},
          {"pose.hands", hands_.fd()},
          {"guest.camera", pictures_.fd()},
          {"guest.camera2", second_pictures_.fd()},
          {"guest.pose", poses_.fd()},
          {"guest.landmarks", landmarks_.fd()},
          {"guest.landmarks2", second_landmarks_.fd()}});
    ASSERT_EQ(turning([this] { return handcast_rig_open("", &rig_); }), HANDCAST_OK) << sentence_;
  }
  void TearDown() override { handcast_rig_close(rig_); }

  /// The result of a call that may ask the rig.
  template <class Call>
  handcast_result turning(const Call& call) {
    const auto [result, sentence] = while_it_turns([&] {
      return std::pair{handcast_result(call()), std::string(handcast_error())};
    });
    sentence_ = sentence;
    return result;
  }
  handcast_result send(const handcast_both_hands& hands) {
    return turning([&] { return handcast_send_hands(rig_, &hands); });
  }
  static handcast_both_hands hands_of(std::int64_t time_ns) {
    handcast_both_hands hands{};
    hands.time_ns = time_ns;
    hands.is_there[1] = 1;
    for (auto& joint : hands.joints[1]) joint.orientation_xyzw[3] = 1;
    return hands;
  }
  template <class T>
  static ipc::Segment ring(const char* stream, std::size_t bytes = sizeof(T)) {
    return must(ipc::Segment::create(ipc::RingSpec::of<T>(stream, 8, true, bytes)));
  }

  ipc::Segment images_ = ring<msg::CameraFrame>("camera.frames", msg::CameraFrame::bytes(4, 3)),
               pictures_ = ring<msg::CameraFrame>("guest.camera", msg::CameraFrame::bytes(4, 3)),
               second_pictures_ =
                   ring<msg::CameraFrame>("guest.camera2", msg::CameraFrame::bytes(4, 3)),
               hands_ = ring<msg::HandPoses>("pose.hands"),
               poses_ = ring<msg::HandPoses>("guest.pose"),
               landmarks_ = ring<msg::Landmarks>("guest.landmarks"),
               second_landmarks_ = ring<msg::Landmarks>("guest.landmarks2");
  handcast_rig* rig_ = nullptr;
  std::string sentence_;
};

TEST_F(HandcastRig, GivesTheNewestImage) {
  auto writer = must(ipc::Writer<msg::CameraFrame>::attach(again(images_)));
  for (std::uint64_t number = 1; number <= 2; ++number) {
    auto frame = writer.loan();
    frame->header = {number, 100 + static_cast<std::int64_t>(number), 0};
    frame->width_px = 4;
    frame->height_px = 3;
    std::fill_n(frame->pixels(), 12, static_cast<std::uint8_t>(number));
    writer.publish(std::move(frame));
  }
  handcast_image image;
  ASSERT_EQ(turning([&] { return handcast_wait_image(rig_, &image, 1000); }), HANDCAST_OK);
  EXPECT_EQ(image.number, 2u);
  EXPECT_EQ(image.time_ns, 102);
  EXPECT_EQ(image.width, 4);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(image.pixels[11], 2);
  EXPECT_EQ(handcast_wait_image(rig_, &image, 0), HANDCAST_TIMEOUT);
  EXPECT_EQ(image.pixels, nullptr);
}

TEST_F(HandcastRig, GivesEachSampleOfTheTrackerOnce) {
  auto writer = must(ipc::Writer<msg::HandPoses>::attach(again(hands_)));
  msg::HandPoses poses;
  poses.header.origin_ns = 5;
  poses.count = 1;
  writer.publish(poses);
  handcast_both_hands hands;
  ASSERT_EQ(turning([&] { return handcast_wait_hands(rig_, &hands, 1000); }), HANDCAST_OK);
  EXPECT_EQ(hands.time_ns, 5);
  EXPECT_EQ(hands.is_there[0], 1);
  EXPECT_EQ(handcast_wait_hands(rig_, &hands, 0), HANDCAST_TIMEOUT);
  EXPECT_EQ(hands.is_there[0], 0);
}

TEST_F(HandcastRig, SendsHands) {
  auto reader = must(ipc::Reader<msg::HandPoses>::watch(again(poses_)));
  auto hands = hands_of(handcast_now());
  hands.joints[1][10].position_m[2] = 0.25f;
  ASSERT_EQ(send(hands), HANDCAST_OK) << sentence_;
  const auto sent = must(reader.latest(Deadline::now()));
  ASSERT_EQ(sent->count, 1u);
  EXPECT_EQ(sent->header.origin_ns, hands.time_ns);
  EXPECT_EQ(sent->hands[0].side, msg::Side::right);
  EXPECT_EQ(sent->hands[0].confidence, 1);
  EXPECT_EQ(sent->hands[0].joints[10].position_m[2], 0.25f);
}

TEST_F(HandcastRig, SendsLandmarks) {
  auto reader = must(ipc::Reader<msg::Landmarks>::watch(again(landmarks_)));
  handcast_landmarks found{};
  found.image = 9;
  found.time_ns = handcast_now();
  found.presence[0] = 0.5f;
  found.points[0][20] = {3, 4, 1, 2};
  ASSERT_EQ(turning([&] { return handcast_send_landmarks(rig_, &found); }), HANDCAST_OK);
  const auto sent = must(reader.latest(Deadline::now()));
  ASSERT_EQ(sent->count, 1u);
  EXPECT_EQ(sent->header.frame_id, 9u);
  EXPECT_EQ(sent->hands[0].presence, 0.5f);
  EXPECT_EQ(sent->hands[0].points[20].y_px, 4);
  EXPECT_EQ(sent->hands[0].points[20].sigma_px, 2);
}

TEST_F(HandcastRig, SendsImages) {
  auto reader = must(ipc::Reader<msg::CameraFrame>::watch(again(pictures_)));
  const std::array<std::uint8_t, 12> pixels{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  handcast_image image{pixels.data(), 4, 3, 6, handcast_now(), 0};
  const auto send = [&] { return turning([&] { return handcast_send_image(rig_, &image); }); };
  ASSERT_EQ(send(), HANDCAST_OK) << sentence_;
  const auto sent = must(reader.latest(Deadline::now()));
  EXPECT_EQ(sent->header.frame_id, 6u);
  EXPECT_EQ(sent->header.origin_ns, image.time_ns);
  EXPECT_EQ(sent->pixels()[11], 12);
  for (const auto& [width, height] : {std::pair{4, 4}, {0, 3}, {-1, -1}, {1 << 30, 1 << 30}}) {
    image = {pixels.data(), width, height, 7, handcast_now(), 0};
    EXPECT_EQ(send(), HANDCAST_BAD_DATA) << width << "x" << height;
  }
  image = {nullptr, 4, 3, 8, handcast_now(), 0};
  EXPECT_EQ(send(), HANDCAST_WRONG_USE);
}

TEST_F(HandcastRig, SendsWhatIsOfASecondCamera) {
  auto images = must(ipc::Reader<msg::CameraFrame>::watch(again(second_pictures_)));
  auto hands = must(ipc::Reader<msg::Landmarks>::watch(again(second_landmarks_)));
  const std::array<std::uint8_t, 12> pixels{};
  handcast_image image{pixels.data(), 4, 3, 6, handcast_now(), 1};
  handcast_landmarks found{};
  found.time_ns = handcast_now();
  found.camera = 1;
  const auto send_image = [&] {
    return turning([&] { return handcast_send_image(rig_, &image); });
  };
  const auto send = [&] { return turning([&] { return handcast_send_landmarks(rig_, &found); }); };
  EXPECT_EQ(send_image(), HANDCAST_OK) << sentence_;
  EXPECT_EQ(send(), HANDCAST_OK) << sentence_;
  EXPECT_EQ(must(images.latest(Deadline::now()))->header.frame_id, 6u);
  EXPECT_TRUE(hands.latest(Deadline::now()));
  image.camera = 2;
  found.camera = -1;
  EXPECT_EQ(send_image(), HANDCAST_WRONG_USE);
  EXPECT_EQ(send(), HANDCAST_WRONG_USE);
  EXPECT_THAT(sentence_, HasSubstr("`camera` is neither 0 nor 1"));
}

TEST_F(HandcastRig, WhatTheRigWouldLeaveOutIsNotSentAndTheSentenceSaysWhy) {
  auto reader = must(ipc::Reader<msg::HandPoses>::watch(again(poses_)));
  EXPECT_EQ(send(hands_of(0)), HANDCAST_BAD_DATA);
  EXPECT_THAT(sentence_, HasSubstr("CLOCK_MONOTONIC"));
  auto hands = hands_of(handcast_now());
  hands.joints[1][3].position_m[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(send(hands), HANDCAST_BAD_DATA);
  EXPECT_THAT(sentence_, HasSubstr("joint 3"));
  EXPECT_FALSE(reader.latest(Deadline::now()));
  const auto good = hands_of(handcast_now());
  EXPECT_EQ(send(good), HANDCAST_OK) << sentence_;
  EXPECT_EQ(send(good), HANDCAST_BAD_DATA) << "twice the same time";
}

TEST_F(HandcastRig, TwoProgramsCannotBeTheTracker) {
  handcast_rig* other = nullptr;
  ASSERT_EQ(turning([&] { return handcast_rig_open("", &other); }), HANDCAST_OK);
  ASSERT_EQ(send(hands_of(handcast_now())), HANDCAST_OK) << sentence_;
  const auto hands = hands_of(handcast_now());
  EXPECT_EQ(turning([&] { return handcast_send_hands(other, &hands); }), HANDCAST_UNAVAILABLE);
  EXPECT_THAT(sentence_, HasSubstr("another"));
  handcast_rig_close(rig_);
  rig_ = nullptr;
  EXPECT_EQ(turning([&] { return handcast_send_hands(other, &hands); }), HANDCAST_OK) << sentence_;
  handcast_rig_close(other);
}

TEST_F(HandcastRig, WrongUseIsASentence) {
  handcast_both_hands hands{};
  handcast_image image{};
  handcast_landmarks found{};
  EXPECT_EQ(handcast_rig_open("", nullptr), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_wait_image(rig_, nullptr, 0), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_wait_image(rig_, &image, -1), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_wait_hands(rig_, nullptr, 0), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_send_hands(rig_, nullptr), HANDCAST_WRONG_USE);
  EXPECT_EQ(handcast_send_landmarks(rig_, nullptr), HANDCAST_WRONG_USE);
  auto* const closed = rig_;
  handcast_rig_close(rig_);
  rig_ = nullptr;
  for (auto* const rig : {static_cast<handcast_rig*>(nullptr), closed}) {
    EXPECT_EQ(handcast_wait_image(rig, &image, 0), HANDCAST_WRONG_USE);
    EXPECT_THAT(handcast_error(), HasSubstr("handcast_rig_open()"));
    EXPECT_EQ(handcast_wait_hands(rig, &hands, 0), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_send_hands(rig, &hands), HANDCAST_WRONG_USE);
    EXPECT_EQ(handcast_send_landmarks(rig, &found), HANDCAST_WRONG_USE);
    handcast_rig_close(rig);
  }
  EXPECT_EQ(handcast_abi(), HANDCAST_ABI);
}

}  // namespace
}  // namespace handcast::client
