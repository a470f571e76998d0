// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/input_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <fstream>

#include "tests/scratch.hpp"

namespace handcast {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class InputFile : public testing::Test {
 protected:
  std::string refusal(const std::filesystem::path& file, std::uint64_t most_bytes = 100) {
    const auto read = read_input(file, most_bytes);
    return read ? "read" : read.error().what;
  }
  test::Scratch scratch_;
};

TEST_F(InputFile, IsReadWhole) {
  const std::string bytes("a\0b\nc", 5);
  std::ofstream(scratch_.path() / "file", std::ios::binary) << bytes;
  EXPECT_EQ(read_input(scratch_.path() / "file", 5).value(), bytes);
  std::ofstream(scratch_.path() / "empty");
  EXPECT_EQ(read_input(scratch_.path() / "empty", 5).value(), "");
}

TEST_F(InputFile, ThatIsNotThereIsNamedWithTheReason) {
  EXPECT_EQ(refusal("/nowhere/rig.toml"),
            "/nowhere/rig.toml: cannot be read: No such file or directory");
}

TEST_F(InputFile, ThatCannotBeReadNowMayBeReadLater) {
  std::ofstream(scratch_.path() / "file") << "1";
  rlimit usual{};
  getrlimit(RLIMIT_NOFILE, &usual);
  const rlimit none{.rlim_cur = 0, .rlim_max = usual.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  const auto read = read_input(scratch_.path() / "file", 100);
  setrlimit(RLIMIT_NOFILE, &usual);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::unavailable);
  EXPECT_EQ(read_input("/nowhere/rig.toml", 100).error().code, Errc::bad_config);
}

TEST_F(InputFile, WithOneByteTooManyIsRefused) {
  std::ofstream(scratch_.path() / "file") << "123456";
  EXPECT_THAT(refusal(scratch_.path() / "file", 5), HasSubstr("at most 0 MB are read"));
  EXPECT_EQ(read_input(scratch_.path() / "file", 6).value(), "123456");
}

// Files of /proc are regular and have a size of 0.
TEST_F(InputFile, IsReadToItsEndAndNotToItsSize) {
  const auto limits = read_input("/proc/self/limits", 1 << 20);
  ASSERT_TRUE(limits) << limits.error().what;
  EXPECT_THAT(*limits, HasSubstr("Max open files"));
  EXPECT_THAT(refusal("/proc/self/limits", 5), HasSubstr("at most 0 MB are read"));
  EXPECT_EQ(refusal("/proc/self/mem"), "/proc/self/mem: cannot be read: Input/output error");
}

TEST_F(InputFile, ThatIsNoFileIsRefusedAtOnceAndNeverWaitedFor) {
  ASSERT_EQ(mkfifo((scratch_.path() / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal(scratch_.path() / "pipe"), HasSubstr("it is a pipe, not a file"));
  EXPECT_THAT(refusal("/dev/zero"), HasSubstr("/dev/zero: cannot be read: it is a device"));
  EXPECT_THAT(refusal(scratch_.path()), HasSubstr("it is a folder, not a file"));

  const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  const auto name = (scratch_.path() / "socket").string();
  name.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  EXPECT_THAT(refusal(name), HasSubstr("it is not a file"));
}

}  // namespace
}  // namespace handcast
