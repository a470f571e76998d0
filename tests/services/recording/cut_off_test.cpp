// SPDX-License-Identifier: Apache-2.0
// Recordings that end in the middle: after a crash, a power cut, a copy that was interrupted.
#include <gtest/gtest.h>

#include "services/recording/recording_reader.hpp"
#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kCount = 6;

/// Number of messages that can be read; each must be the one that was written.
std::uint32_t readable(const fs::path& folder) {
  auto reader = StreamReader::open<msg::CameraFrame>(folder, "camera.frames");
  if (!reader) return 0;
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < reader->rows().size(); ++k) {
    msg::CameraFrame frame;
    std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
    EXPECT_TRUE(reader->read(k, frame, pixels)) << "message " << k << " of the index";
    EXPECT_EQ(std::memcmp(pixels.data(), test::frame(k)->pixels(), pixels.size()), 0);
    ++count;
  }
  return count;
}

class CutOff : public testing::Test {
 protected:
  CutOff() { test::write(folder_, kCount); }
  handcast::test::Scratch scratch_;
  fs::path folder_ = scratch_.path() / "recording";
  fs::path index_ = folder_ / "camera.frames.index", data_ = folder_ / "camera.frames.data";
};

TEST_F(CutOff, AnIndexCutAtAnyByteGivesItsWholeRows) {
  const auto whole = test::contents(index_);
  for (std::size_t size = whole.size() + 1; size-- > 0;) {
    fs::resize_file(index_, size);
    EXPECT_EQ(readable(folder_), size / sizeof(IndexRow)) << size << " bytes";
  }
}

TEST_F(CutOff, DataCutAtAnyByteGivesTheMessagesBeforeTheCut) {
  const auto reader = StreamReader::open(folder_, "camera.frames");
  ASSERT_TRUE(reader);
  const auto rows = reader->rows();
  for (std::size_t size = fs::file_size(data_) + 1; size-- > 0;) {
    fs::resize_file(data_, size);
    const auto whole =
        std::ranges::count_if(rows, [&](const auto& row) { return row.end() <= size; });
    EXPECT_EQ(readable(folder_), static_cast<std::uint32_t>(whole)) << size << " bytes";
  }
}

/// After a power cut the file may have its size, but not its contents.
TEST_F(CutOff, ZerosInsteadOfDataAreFoundByTheChecksum) {
  auto reader = StreamReader::open<msg::CameraFrame>(folder_, "camera.frames");
  auto data = test::contents(data_);
  const auto last = reader->rows().back();
  std::fill(data.begin() + static_cast<std::ptrdiff_t>(last.offset), data.end(), '\0');
  test::replace(data_, data);
  msg::CameraFrame frame;
  std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
  EXPECT_TRUE(reader->read(kCount - 2, frame, pixels));
  const auto read = reader->read(kCount - 1, frame, pixels);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::bad_data);
}

TEST_F(CutOff, ADescriptionThatWasCutIsAnErrorNotACrash) {
  const auto whole = test::contents(folder_ / "recording.json");
  for (std::size_t size = 0; size + 2 < whole.size(); size += 7) {
    test::replace(folder_ / "recording.json", whole.substr(0, size));
    EXPECT_FALSE(StreamReader::open(folder_, "camera.frames")) << size << " bytes";
  }
}

}  // namespace
}  // namespace handcast::recording
