// SPDX-License-Identifier: Apache-2.0
// Recordings that somebody or something has changed.
#include <gtest/gtest.h>

#include <random>

#include "services/recording/playback.hpp"
#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::recording {
namespace {

namespace fs = std::filesystem;

class Hostile : public testing::Test {
 protected:
  Hostile() {
    test::write(folder_, 3);
    original_ = test::contents(folder_ / "camera.frames.index");
  }

  /// What reading message 1 gives after its row was changed.
  template <class Change>
  Result<void> read_changed(const Change& change) {
    auto bytes = original_;
    IndexRow row;
    std::memcpy(&row, bytes.data() + sizeof row, sizeof row);
    change(row);
    std::memcpy(bytes.data() + sizeof row, &row, sizeof row);
    test::replace(folder_ / "camera.frames.index", bytes);
    auto reader = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
    if (!reader) return tl::make_unexpected(reader.error());
    if (reader->rows().size() < 3) return fail(Errc::bad_data, "the row is left out");
    msg::CameraFrame frame;
    std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
    return reader->read(1, frame, pixels);
  }

  handcast::test::Scratch scratch_;
  fs::path folder_ = scratch_.path() / "recording";
  std::string original_;  ///< the index
};

TEST_F(Hostile, RowsWithImpossibleValuesAreRefused) {
  EXPECT_TRUE(read_changed([](IndexRow&) {}));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.offset = ~0ull; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.offset = ~0ull - row.head_bytes; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.head_bytes = 1 << 20; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.image_bytes = ~0u; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.width_px = ~0u; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.width_px = row.height_px = 1 << 16; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { std::swap(row.width_px, row.height_px); }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.width_px = 0; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.image_bytes = 0; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.crc ^= 1; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.published_ns = INT64_MAX; }));
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.origin_ns = INT64_MIN; }));
}

TEST_F(Hostile, ADamagedRowHidesNoOther) {
  EXPECT_FALSE(read_changed([](IndexRow& row) { row.offset = ~0ull; }));
  auto reader = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
  ASSERT_TRUE(reader);
  ASSERT_EQ(reader->rows().size(), 2u);
  EXPECT_EQ(reader->rows()[1].sequence, 2u) << "the last message";
  msg::CameraFrame frame;
  std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
  EXPECT_TRUE(reader->read(1, frame, pixels));
}

TEST_F(Hostile, ASmallerPlaceThanTheImageIsAnError) {
  auto reader = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
  msg::CameraFrame frame;
  std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight - 1);
  const auto read = reader->read(0, frame, pixels);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::bad_config);
}

TEST_F(Hostile, AMessageWithMoreHandsThanThereAreIsDamaged) {
  auto poses = test::poses(0);
  poses.count = 3;
  const auto other = scratch_.path() / "other";
  {
    auto writer = test::writer(other);
    ASSERT_TRUE(writer.append(1, poses, 0, 0));
  }
  auto reader = StreamReader::open<msg::HandPoses>(other, "pose.hands");
  EXPECT_FALSE(reader->read(0, poses));
}

TEST_F(Hostile, TimesThatDoNotIncreaseAreNotPlayed) {
  auto writer = test::writer(scratch_.path() / "other");
  ASSERT_TRUE(writer.append(0, *test::frame(3), 0, 0));
  ASSERT_TRUE(writer.append(0, *test::frame(2), 1, 0));
  const auto reader = StreamReader::open(scratch_.path() / "other", "camera.frames");
  ASSERT_TRUE(reader);
  EXPECT_FALSE(Schedule::make(scratch_.path() / "other", *reader, 0, true));
}

TEST_F(Hostile, AnyChangedByteIsAnErrorOrGivesOtherBytesButNothingWorse) {
  std::mt19937 dice(5);
  for (const auto* name : {"camera.frames.index", "camera.frames.data", "recording.json"}) {
    const auto whole = test::contents(folder_ / name);
    for (int i = 0; i < 300; ++i) {
      auto bytes = whole;
      bytes[dice() % bytes.size()] = static_cast<char>(dice());
      test::replace(folder_ / name, bytes);
      auto reader = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
      if (!reader) continue;
      (void)Schedule::make(folder_, *reader, 0, true);
      for (std::size_t k = 0; k < reader->rows().size(); ++k) {
        msg::CameraFrame frame;
        std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
        (void)reader->read(k, frame, pixels);
      }
    }
    test::replace(folder_ / name, whole);
  }
}

}  // namespace
}  // namespace handcast::recording
