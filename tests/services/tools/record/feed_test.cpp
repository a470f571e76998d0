// SPDX-License-Identifier: Apache-2.0
// Feeds of a real ring: what happens if the disk is too slow.
#include "services/tools/record/feed.hpp"

#include <gtest/gtest.h>

#include "ipc/ring/writer.hpp"

namespace handcast::record {
namespace {

constexpr std::size_t kRoom = 4;  ///< messages that fit into the memory of the feed

class SlowDisk : public testing::Test {
 protected:
  std::unique_ptr<Feed> feed(std::int64_t begin_ns = 0) {
    auto reader =
        ipc::Reader<msg::HandPoses>::watch(ipc::Segment::open(UniqueFd(::dup(ring_.fd()))).value());
    const client::RigPresence presence("nobody", "pose.hands", 0, {.silence_ns = INT64_MAX / 4});
    return feed_of(client::Stream<msg::HandPoses>(std::move(*reader), presence, "nobody"),
                   {0, kRoom * sizeof(msg::HandPoses), begin_ns});
  }
  void publish(int count) {
    for (int i = 0; i < count; ++i) {
      msg::HandPoses poses;
      poses.header.frame_id = next_++;
      writer_.publish(poses);
    }
  }
  static std::uint64_t id_of(const Queued& message) {
    return std::visit([](const auto& sample) { return sample->header.frame_id; }, message.sample);
  }

  ipc::Segment ring_ =
      ipc::Segment::create(ipc::RingSpec::of<msg::HandPoses>("pose.hands", 16, true)).value();
  ipc::Writer<msg::HandPoses> writer_ =
      ipc::Writer<msg::HandPoses>::attach(ipc::Segment::open(UniqueFd(::dup(ring_.fd()))).value(),
                                          Deadline::now())
          .value();
  MessageQueue queue_;
  std::uint64_t next_ = 0;
};

TEST_F(SlowDisk, MessagesWithoutRoomAreLostAndCountedAtTheNextOne) {
  const auto reader = feed();
  publish(7);
  ASSERT_TRUE(reader->read(queue_, Deadline::now()));
  EXPECT_EQ(reader->lost(), 3u);
  for (std::uint64_t k = 0; k < kRoom; ++k) {
    const auto message = queue_.pop();
    EXPECT_EQ(id_of(*message), k);
    EXPECT_EQ(message->lost, 0u);
    reader->written(bytes_of(message->sample));
  }
  publish(1);
  ASSERT_TRUE(reader->read(queue_, Deadline::now()));
  const auto message = queue_.pop();
  EXPECT_EQ(id_of(*message), 7u);
  EXPECT_EQ(message->lost, 3u);
  EXPECT_EQ(reader->lost(), 0u);
}

TEST_F(SlowDisk, MessagesThatTheRingHasOverwrittenAreCountedToo) {
  const auto reader = feed();
  publish(1);
  ASSERT_TRUE(reader->read(queue_, Deadline::now()));
  publish(20);  // the ring has 16 slots
  ASSERT_TRUE(reader->read(queue_, Deadline::now()));
  std::uint64_t all = reader->lost();
  queue_.close();
  for (auto message = queue_.pop(); message; message = queue_.pop()) all += 1 + message->lost;
  EXPECT_EQ(all, 21u);
}

TEST_F(SlowDisk, WhatWasPublishedBeforeTheRecordingIsLeftOut) {
  publish(3);
  const auto begin_ns = now_ns();
  publish(2);
  const auto reader = feed(begin_ns);
  ASSERT_TRUE(reader->read(queue_, Deadline::now()));
  const auto first = queue_.pop();
  EXPECT_EQ(id_of(*first), 3u);
  EXPECT_EQ(first->lost, 0u);
}

}  // namespace
}  // namespace handcast::record
