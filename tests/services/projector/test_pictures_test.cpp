// SPDX-License-Identifier: Apache-2.0
#include "services/projector/test_pictures.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "ipc/ring/writer.hpp"

namespace handcast::projector {
namespace {

constexpr int kWidth_px = 8, kHeight_px = 4;
constexpr std::int64_t kTarget_ns = 77;

class TestPicturesTest : public testing::Test {
 protected:
  void publish(std::uint64_t number, std::uint8_t level, std::uint32_t width_px = kWidth_px) {
    auto slot = writer_.loan();
    slot->header.frame_id = number;
    slot->width_px = width_px;
    slot->height_px = kHeight_px;
    std::fill_n(slot->levels(), width_px * kHeight_px, level);
    writer_.publish(std::move(slot));
  }
  ipc::Segment again() const { return *ipc::Segment::open(UniqueFd(::dup(segment_.fd()))); }

  ipc::Segment segment_ = *ipc::Segment::create(ipc::RingSpec::of<msg::TestPicture>(
      std::string(msg::kTestPictures), 4, false, msg::TestPicture::bytes(16, 16)));
  ipc::Writer<msg::TestPicture> writer_ = *ipc::Writer<msg::TestPicture>::attach(again());
  TestPictures pictures_{*ipc::Reader<msg::TestPicture>::attach(again()), kWidth_px, kHeight_px};
};

TEST_F(TestPicturesTest, WithoutAPictureHandsAreDrawn) {
  EXPECT_EQ(pictures_.at(now_ns(), kTarget_ns), nullptr);
}

TEST_F(TestPicturesTest, APictureFillsTheScreenWithItsLevels) {
  publish(5, 0x40);
  const auto* frame = pictures_.at(now_ns(), kTarget_ns);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->test_picture, 5u);
  EXPECT_EQ(frame->target_ns, kTarget_ns);
  EXPECT_EQ(frame->region.width(), kWidth_px);
  EXPECT_EQ(frame->region.height(), kHeight_px);
  EXPECT_EQ(frame->colour.at(kWidth_px - 1, kHeight_px - 1), 0xff404040u);
  EXPECT_TRUE(frame->hands.empty());
}

TEST_F(TestPicturesTest, ASecondProjectorIsBlackWhileTheFirstShowsOne) {
  TestPictures second(*ipc::Reader<msg::TestPicture>::attach(again()), kWidth_px, kHeight_px,
                      config::Viewpoint::second);
  EXPECT_EQ(second.at(now_ns(), kTarget_ns), nullptr);
  publish(5, 0x40, kWidth_px + 1);
  const auto* frame = second.at(now_ns(), kTarget_ns);
  ASSERT_NE(frame, nullptr) << "a picture of the first one's size";
  EXPECT_EQ(frame->colour.at(kWidth_px - 1, kHeight_px - 1), 0xff000000u);
}

TEST_F(TestPicturesTest, TheTimeOfAPictureIsMarkedAsThatOfAFrame) {
  publish(5, 0x40);
  const auto begin_ns = now_ns();
  const auto* frame = pictures_.at(begin_ns, kTarget_ns);
  ASSERT_NE(frame, nullptr);
  ASSERT_EQ(frame->stages.size(), 1u);
  EXPECT_EQ(frame->stages[0].stage, msg::Stage::frame);
  EXPECT_EQ(frame->stages[0].begin_ns, begin_ns);
}

TEST_F(TestPicturesTest, APictureStaysUntilItsTimeIsOverAndThenHandsAreDrawn) {
  publish(5, 0x40);
  const auto published_ns = now_ns();
  ASSERT_NE(pictures_.at(published_ns, kTarget_ns), nullptr);
  EXPECT_NE(pictures_.at(published_ns + msg::TestPicture::kLasting_ns / 2, kTarget_ns), nullptr);
  EXPECT_EQ(pictures_.at(published_ns + msg::TestPicture::kLasting_ns + 1, kTarget_ns), nullptr);
}

TEST_F(TestPicturesTest, TheNewestPictureIsShown) {
  publish(5, 0x40);
  publish(6, 0x80);
  EXPECT_EQ(pictures_.at(now_ns(), kTarget_ns)->colour.at(0, 0), 0xff808080u);
}

TEST_F(TestPicturesTest, APictureIsMirroredAsTheLightIs) {
  auto slot = writer_.loan();
  slot->header.frame_id = 1;
  slot->width_px = kWidth_px;
  slot->height_px = kHeight_px;
  std::fill_n(slot->levels(), kWidth_px * kHeight_px, 0x40);
  slot->levels()[0] = 0xff;
  writer_.publish(std::move(slot));
  const auto bright = [&](config::Flip flip, int x, int y) {
    return (pictures_.at(now_ns(), kTarget_ns, flip)->colour.at(x, y) & 255) == 0xff;
  };
  EXPECT_TRUE(bright(config::Flip::none, 0, 0));
  EXPECT_TRUE(bright(config::Flip::horizontal, kWidth_px - 1, 0));
  EXPECT_TRUE(bright(config::Flip::vertical, 0, kHeight_px - 1));
  EXPECT_TRUE(bright(config::Flip::both, kWidth_px - 1, kHeight_px - 1));
  EXPECT_TRUE(bright(config::Flip::none, 0, 0)) << "the same picture as before";
}

TEST_F(TestPicturesTest, APictureOfAnotherSizeIsLeftOut) {
  publish(5, 0x40, kWidth_px + 1);
  EXPECT_EQ(pictures_.at(now_ns(), kTarget_ns), nullptr);
}

}  // namespace
}  // namespace handcast::projector
