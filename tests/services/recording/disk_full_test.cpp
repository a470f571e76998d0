// SPDX-License-Identifier: Apache-2.0
// Disks without room: a limit of the size of files, which the kernel keeps as it keeps that of a
// disk.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>

#include "services/recording/recording_reader.hpp"
#include "tests/scratch.hpp"
#include "tests/services/recording/recordings.hpp"

namespace handcast::recording {
namespace {

namespace fs = std::filesystem;

/// No file of this process grows beyond so many bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

/// Writes until the disk is full. Returns the number of whole messages, and the error.
std::pair<std::uint32_t, Error> fill(const fs::path& folder) {
  auto writer = test::writer(folder);
  for (std::uint32_t k = 0; k < 1000; ++k)
    if (auto written = writer.append(0, *test::frame(k), k, 0); !written) {
      EXPECT_TRUE(writer.finish(written.error().what, {1, 0, 0}));
      return {k, written.error()};
    }
  return {1000, {}};
}

TEST(DiskFull, EndsWithASentenceAndKeepsWhatIsWhole) {
  // Each size hits another place: the data, its middle, the index.
  for (rlim_t bytes = 4000; bytes < 4200; bytes += 7) {
    handcast::test::Scratch scratch;
    const FileSizeLimit limit(bytes);
    const auto [count, error] = fill(scratch.path() / "recording");
    ASSERT_LT(count, 1000u);
    ASSERT_GT(count, 10u);
    EXPECT_EQ(error.code, Errc::unavailable);
    EXPECT_THAT(error.what, testing::HasSubstr("the disk is full"));
    auto reader =
        StreamReader::open<msg::CameraFrame>(scratch.path() / "recording", "camera.frames");
    ASSERT_TRUE(reader) << reader.error().what;
    ASSERT_EQ(reader->rows().size(), count);
    EXPECT_EQ(fs::file_size(scratch.path() / "recording/camera.frames.data"),
              reader->rows().back().end());
    msg::CameraFrame frame;
    std::vector<std::uint8_t> pixels(test::kWidth * test::kHeight);
    EXPECT_TRUE(reader->read(count - 1, frame, pixels));
  }
}

}  // namespace
}  // namespace handcast::recording
