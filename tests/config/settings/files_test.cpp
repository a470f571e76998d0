// SPDX-License-Identifier: Apache-2.0
#include "config/settings/files.hpp"

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace handcast::config
