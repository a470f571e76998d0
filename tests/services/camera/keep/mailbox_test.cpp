// SPDX-License-Identifier: Apache-2.0
#include "services/camera/keep/mailbox.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;

struct Picture {
  int pixels = 0;
  std::uint64_t number = 0;
  std::int64_t exposed_ns = 0;
  msg::FrameLosses lost;
};

class MailboxTest : public testing::Test {
 protected:
  void put(int pixels, const msg::FrameLosses& lost = {}, std::uint64_t steps = 1) {
    Picture picture{.pixels = pixels, .lost = lost};
    mailbox_.put(picture, steps);
  }
  Picture take() {
    Picture picture;
    EXPECT_TRUE(mailbox_.take(picture, Deadline::now()));
    return picture;
  }

  Mailbox<Picture> mailbox_{7};
};

TEST_F(MailboxTest, AnImageIsTakenOnceAndItsNumberCountsExposures) {
  put(1);
  EXPECT_EQ(take().number, 7u);
  Picture none;
  EXPECT_FALSE(mailbox_.take(none, Deadline::now()));
  put(2, {.missing = 2}, 3);
  const auto second = take();
  EXPECT_EQ(second.pixels, 2);
  EXPECT_EQ(second.number, 10u);
  EXPECT_EQ(second.lost.missing, 2u);
}

TEST_F(MailboxTest, WhatIsLostBehindAWaitingImageCountsForTheNext) {
  put(1);
  mailbox_.count({.incomplete = 1}, 1);
  EXPECT_EQ(take().lost.incomplete, 0u);
  put(2);
  const auto second = take();
  EXPECT_EQ(second.number, 9u);
  EXPECT_EQ(second.lost.incomplete, 1u);
}

TEST_F(MailboxTest, AReplacedImageIsSkippedAndWhatWasLostBeforeItStaysCounted) {
  put(1, {.missing = 2}, 3);
  mailbox_.count({.incomplete = 1}, 1);
  put(2, {.underrun = 4}, 5);
  const auto newest = take();
  EXPECT_EQ(newest.pixels, 2);
  EXPECT_EQ(newest.lost.missing, 2u);
  EXPECT_EQ(newest.lost.incomplete, 1u);
  EXPECT_EQ(newest.lost.underrun, 4u);
  EXPECT_EQ(newest.lost.skipped, 1u);
  put(3);
  EXPECT_EQ(take().lost.skipped, 0u);
}

TEST_F(MailboxTest, ADroppedImageIsSkippedToo) {
  put(1, {.missing = 1}, 2);
  mailbox_.clear();
  mailbox_.clear();
  Picture none;
  EXPECT_FALSE(mailbox_.take(none, Deadline::now()));
  put(2);
  const auto next = take();
  EXPECT_EQ(next.lost.missing, 1u);
  EXPECT_EQ(next.lost.skipped, 1u);
}

TEST_F(MailboxTest, BuffersGoRound) {
  put(1);
  Picture picture{.pixels = 5};
  ASSERT_TRUE(mailbox_.take(picture, Deadline::now()));
  mailbox_.put(picture, 1);
  EXPECT_EQ(picture.pixels, 5) << "what the taker gave";
}

TEST_F(MailboxTest, SignsAndExposuresAreTold) {
  EXPECT_EQ(mailbox_.last_sign_ns(), 0);
  const auto before_ns = now_ns();
  mailbox_.count({.incomplete = 1}, 1);
  EXPECT_GE(mailbox_.last_sign_ns(), before_ns);
  EXPECT_EQ(mailbox_.last_exposed_ns(), 0);
  Picture picture{.exposed_ns = 42};
  mailbox_.put(picture, 1);
  EXPECT_EQ(mailbox_.last_exposed_ns(), 42);
}

TEST_F(MailboxTest, ATakerWaitsForTheNextImage) {
  Picture picture;
  std::jthread putter([this] {
    sleep_until_ns(now_ns() + 20'000'000);
    put(1);
  });
  EXPECT_TRUE(mailbox_.take(picture, Deadline::in(20s)));
}

}  // namespace
}  // namespace handcast::camera
