// SPDX-License-Identifier: Apache-2.0
// Payloads, and the images that are made of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/camera/leap/frame_assembler.hpp"
#include "services/camera/leap/little_endian.hpp"

namespace handcast::camera::leap {
namespace {

using PayloadBytes = std::vector<std::uint8_t>;

/// A payload with a header of 12 bytes.
PayloadBytes payload(bool frame_id, bool ends, std::size_t data,
                     std::optional<std::uint32_t> stamp = {}) {
  PayloadBytes bytes(12 + data, 7);
  bytes[0] = 12;
  bytes[1] = static_cast<std::uint8_t>(0x80 | frame_id | (ends ? 2 : 0) | (stamp ? 4 : 0));
  put_32(bytes, 2, stamp.value_or(0));
  return bytes;
}

TEST(Payload, ItsHeaderIsRead) {
  const auto bytes = payload(true, true, 5, 0x01020304);
  const auto parsed = parse_payload(bytes);
  ASSERT_TRUE(parsed);
  EXPECT_TRUE(parsed->frame_id && parsed->ends_frame && !parsed->has_error);
  EXPECT_EQ(parsed->stamp, 0x01020304u);
  EXPECT_EQ(parsed->data.size(), 5u);
  EXPECT_EQ(parsed->data.data(), bytes.data() + 12);
}

TEST(Payload, WhatIsNoHeaderIsSaid) {
  for (const auto& bytes :
       {PayloadBytes{}, PayloadBytes{12}, PayloadBytes(11, 12), PayloadBytes{12, 0x80, 0},
        PayloadBytes{1, 0x80}, PayloadBytes{2, 0x84, 1, 2, 3, 4},
        PayloadBytes{12, 0x00, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}) {
    const auto parsed = parse_payload(bytes);
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.error().code, Errc::bad_data);
    EXPECT_THAT(parsed.error().what, testing::HasSubstr("a payload of"));
  }
}

/// Images of 100 bytes in payloads of 40, 40 and 20; stamps of two images differ by 8.
class Assembler : public testing::Test {
 protected:
  FrameAssembler::Ended take(const PayloadBytes& bytes) {
    return assembler_.take(bytes, ++time_ns_);
  }
  /// Sends the payloads of an image but those in `without`. What its last one ended.
  FrameAssembler::Ended send(std::uint32_t number, std::initializer_list<int> without = {}) {
    FrameAssembler::Ended ended;
    for (int i = 0; i < 3; ++i)
      if (std::ranges::find(without, i) == without.end()) {
        auto now = take(payload(number % 2 == 1, i == 2, i == 2 ? 20 : 40, 8 * number));
        if (now.torn) ended.torn = now.torn;
        ended.own = now.own;
      }
    return ended;
  }

  FrameAssembler assembler_{100, 4};
  std::int64_t time_ns_ = 0;
};

TEST_F(Assembler, AWholeImageHasAllItsBytesAndTheTimeOfItsFirstPayload) {
  const auto ended = send(1);
  ASSERT_TRUE(ended.own && !ended.torn);
  EXPECT_TRUE(ended.own->is_whole);
  EXPECT_EQ(ended.own->first_ns, 1);
  EXPECT_EQ(ended.own->last_ns, 3);
  EXPECT_EQ(ended.own->stamp, 8u);
  EXPECT_THAT(assembler_.bytes(), testing::AllOf(testing::SizeIs(100), testing::Each(7)));
}

TEST_F(Assembler, AnImageWithoutOneOfItsPayloadsIsTornAndTheNextIsWhole) {
  for (const int lost : {0, 1}) {
    const auto ended = send(1, {lost});
    ASSERT_TRUE(ended.own);
    EXPECT_FALSE(ended.own->is_whole);
    const auto next = send(2);
    ASSERT_TRUE(next.own && next.own->is_whole && !next.torn);
  }
}

TEST_F(Assembler, AnImageWithoutItsEndIsTornWhenTheNextBegins) {
  EXPECT_FALSE(send(1, {2}).own);
  const auto next = send(2);
  ASSERT_TRUE(next.torn && next.own);
  EXPECT_FALSE(next.torn->is_whole);
  EXPECT_EQ(next.torn->stamp, 8u);
  EXPECT_TRUE(next.own->is_whole);
}

// Image 1 loses its end, 2 is lost, 3 loses its beginning: the frame ids of 1 and 3 are the same,
// and their parts would have the size of an image.
TEST_F(Assembler, TwoHalvesOfTwoImagesAreNoImage) {
  send(1, {1, 2});
  const auto ended = send(3, {0});
  ASSERT_TRUE(ended.torn && ended.own);
  EXPECT_FALSE(ended.own->is_whole);
  EXPECT_TRUE(send(4).own->is_whole);
}

TEST_F(Assembler, GarbageAndALostTransferTearTheImageAroundThem) {
  take(payload(true, false, 40, 8));
  EXPECT_FALSE(take({0xff, 0x55, 1}).own);
  take(payload(true, false, 40, 8));
  EXPECT_FALSE(take(payload(true, true, 20, 8)).own->is_whole);
  take(payload(false, false, 40, 16));
  assembler_.lose_payload();
  take(payload(false, false, 40, 16));
  EXPECT_FALSE(take(payload(false, true, 20, 16)).own->is_whole);
  EXPECT_EQ(assembler_.strays(), 1u);
  EXPECT_TRUE(send(3).own->is_whole);
}

TEST_F(Assembler, TooManyBytesAreTornNotWritten) {
  take(payload(true, false, 90, 8));
  EXPECT_FALSE(take(payload(true, true, 90, 8)).own->is_whole);
  EXPECT_FALSE(take(payload(false, true, 5000, 16)).own->is_whole);
  EXPECT_TRUE(send(3).own->is_whole);
}

TEST_F(Assembler, ADamagedImageIsTorn) {
  auto damaged = payload(true, false, 40, 8);
  damaged[1] |= 0x40;
  take(damaged);
  take(payload(true, false, 40, 8));
  EXPECT_FALSE(take(payload(true, true, 20, 8)).own->is_whole);
}

TEST_F(Assembler, WhatComesBehindTheEndBeginsNoImage) {
  EXPECT_TRUE(send(1).own->is_whole);
  const auto empty = take(payload(true, true, 0, 8)), full = take(payload(true, true, 20, 8));
  EXPECT_FALSE(empty.own || empty.torn || full.own || full.torn);
  EXPECT_TRUE(send(2).own->is_whole);
}

TEST_F(Assembler, WithoutStampsTheFrameIdTellsImagesApart) {
  const auto half = [&](bool id, bool ends) { return take(payload(id, ends, 50)); };
  half(true, false);
  EXPECT_TRUE(half(true, true).own->is_whole);
  half(true, false);  // the one between is lost
  EXPECT_TRUE(half(true, true).own->is_whole);
  half(false, false);
  const auto ended = half(true, false);
  EXPECT_TRUE(ended.torn && !ended.torn->is_whole);
}

}  // namespace
}  // namespace handcast::camera::leap
