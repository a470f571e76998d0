// SPDX-License-Identifier: Apache-2.0
#include "services/recording/playback.hpp"

#include <gtest/gtest.h>

#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::recording {
namespace {

/// test::write(): images are published from 1.0003 ms on, poses from 9.9 ms on, projections do not
/// count.
constexpr std::int64_t kFirst_ns = 1'000'300, kEpoch_ns = 70'000'000'000;

class Playback : public testing::Test {
 protected:
  Playback() { test::write(folder_, kCount); }
  Schedule schedule(const char* stream, bool repeat) {
    const auto reader = StreamReader::open(folder_, stream);
    return Schedule::make(folder_, *reader, kEpoch_ns, repeat).value();
  }
  static constexpr std::uint32_t kCount = 4;
  handcast::test::Scratch scratch_;
  std::filesystem::path folder_ = scratch_.path() / "recording";
};

TEST_F(Playback, OriginsAndDelaysAreThoseOfTheRecording) {
  const auto images = schedule("camera.frames", true), poses = schedule("pose.hands", true);
  std::int64_t time_ns = 0;
  for (std::uint32_t k = 0; k < kCount; ++k) {
    const auto item = images.at_or_after(time_ns);
    const auto recorded = test::frame(k)->header;
    EXPECT_EQ(item->index, k);
    EXPECT_EQ(item->frame_id, recorded.frame_id);
    EXPECT_EQ(item->due_ns - kEpoch_ns, recorded.published_ns - kFirst_ns);
    EXPECT_EQ(item->due_ns - item->origin_ns, recorded.published_ns - recorded.origin_ns);
    time_ns = item->due_ns + 1;
  }
  const auto pose = poses.at_or_after(0);
  EXPECT_EQ(pose->origin_ns - kEpoch_ns, test::poses(0).header.origin_ns - kFirst_ns)
      << "the sensors keep together";
}

TEST_F(Playback, TheNumbersGoOnFromLapToLap) {
  const auto images = schedule("camera.frames", true);
  std::int64_t time_ns = 0;
  std::uint64_t last_id = 0;
  std::int64_t last_ns = 0;
  for (std::uint32_t k = 0; k < 3 * kCount; ++k) {
    const auto item = images.at_or_after(time_ns);
    EXPECT_EQ(item->number, k);
    EXPECT_GT(item->frame_id, last_id);
    EXPECT_GT(item->due_ns, last_ns);
    last_id = item->frame_id;
    time_ns = (last_ns = item->due_ns) + 1;
  }
}

TEST_F(Playback, WithoutRepetitionItEnds) {
  const auto images = schedule("camera.frames", false);
  EXPECT_TRUE(images.at_or_after(kEpoch_ns));
  EXPECT_FALSE(images.at_or_after(kEpoch_ns + 60'000'000'000));
}

TEST_F(Playback, AnEmptyStreamIsRefused) {
  const auto empty = scratch_.path() / "empty";
  (void)test::writer(empty);
  const auto reader = StreamReader::open(empty, "camera.frames");
  ASSERT_TRUE(reader);
  EXPECT_FALSE(Schedule::make(empty, *reader, 0, true));
}

}  // namespace
}  // namespace handcast::recording
