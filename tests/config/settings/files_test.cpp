// SPDX-License-Identifier: Apache-2.0
#include "config/settings/files.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/scratch.hpp"

namespace handcast::config {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Files : public testing::Test {
 protected:
  test::Scratch scratch_;
  const fs::path& folder_ = scratch_.path();
};

TEST_F(Files, AnEmptyFileIsAnEmptyText) {
  std::ofstream(folder_ / "empty").close();
  const auto text = read_text(folder_ / "empty");
  ASSERT_TRUE(text) << text.error().what;
  EXPECT_EQ(*text, "");
}

TEST_F(Files, OneThatCannotBeReadIsSaidWithTheReason) {
  const auto why = [](const fs::path& file) { return read_text(file).error().what; };
  EXPECT_THAT(why(folder_ / "nowhere"),
              HasSubstr("nowhere: cannot be read: No such file or directory"));
  EXPECT_THAT(why(folder_), HasSubstr("it is a folder, not a file"));
  EXPECT_THAT(why(folder_ / std::string(300, 'x')), HasSubstr("File name too long"));
}

TEST_F(Files, AreReplacedWholeAndNothingIsLeftBeside) {
  const auto file = folder_ / "observer.json";
  ASSERT_TRUE(write_whole(file, "a longer first text"));
  std::ifstream reader(file);
  ASSERT_TRUE(write_whole(file, "second"));
  EXPECT_EQ(read_text(file), "second");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(reader), {}), "a longer first text")
      << "an open reader still gets the whole old file";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  EXPECT_EQ(write_whole("/nowhere/observer.json", "x").error().code, Errc::unavailable);
}

TEST_F(Files, APipeOrFolderIsNotWrittenAndNotWaitedFor) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  for (const auto& [file, kind] : {std::pair{folder_ / "pipe", "a pipe"}, {folder_, "a folder"}}) {
    EXPECT_THAT(write_whole(file, "text").error().what,
                HasSubstr(std::string("cannot be written: it is ") + kind));
    EXPECT_EQ(check_writable(file).error().code, Errc::bad_config);
  }
}

TEST_F(Files, ALinkOrDeviceIsWrittenThroughAndNotReplaced) {
  fs::create_symlink(folder_ / "file", folder_ / "link");
  ASSERT_TRUE(write_whole(folder_ / "link", "text"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_text(folder_ / "file"), "text");
  EXPECT_THAT(write_whole("/dev/full", "text").error().what, HasSubstr("No space left on device"));
}

}  // namespace
}  // namespace handcast::config
