// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/spawn.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {
namespace {

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    read.reset(ends[0]);
    write.reset(ends[1]);
  }
  /// What is written until all writers have ended.
  std::string text() {
    write.reset();
    std::string all;
    std::array<char, 256> part;
    for (ssize_t count; (count = ::read(read.get(), part.data(), part.size())) > 0;)
      all.append(part.data(), static_cast<std::size_t>(count));
    return all;
  }
  UniqueFd read, write;
};

/// What a shell prints.
std::string output_of(const std::string& script, SpawnFiles& files) {
  Pipe printed;
  files.give(printed.write.get(), STDOUT_FILENO);
  const auto pid = spawn({"/bin/sh", "-c", script}, files);
  EXPECT_TRUE(pid);
  const auto text = printed.text();
  int status = 0;
  EXPECT_EQ(waitpid(pid.value_or(-1), &status, 0), pid.value_or(-1));
  EXPECT_TRUE(WIFEXITED(status));
  return text;
}

TEST(Spawn, AProgramHasTheDescriptorsThatItIsGivenAndNoOthers) {
  Pipe given, other;
  SpawnFiles files;
  files.inherit(given.write.get());
  const auto is_open = [](int fd) {
    return "if [ -e /proc/self/fd/" + std::to_string(fd) +
           " ]; then echo open; else echo closed; fi\n";
  };
  EXPECT_EQ(output_of(is_open(given.write.get()) + is_open(other.write.get()), files),
            "open\nclosed\n");
}

TEST(Spawn, TheInputMayBeEmpty) {
  SpawnFiles files;
  files.close_input();
  EXPECT_EQ(output_of("cat; echo end", files), "end\n");
}

TEST(Spawn, AProgramThatIsNotThereIsAnErrorNumber) {
  const auto pid = spawn({"/nowhere/program"}, SpawnFiles());
  ASSERT_FALSE(pid);
  EXPECT_EQ(pid.error(), ENOENT);
}

}  // namespace
}  // namespace handcast::supervisor
