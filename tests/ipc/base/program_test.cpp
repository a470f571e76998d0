// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/program.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"

namespace handcast {
namespace {

using testing::ExitedWithCode;

int run(const std::function<int(int, char**)>& body, std::vector<std::string> arguments = {}) {
  arguments.insert(arguments.begin(), "handcast");
  std::vector<char*> pointers;
  for (auto& argument : arguments) pointers.push_back(argument.data());
  return run_program("handcast", static_cast<int>(pointers.size()), pointers.data(), body);
}

TEST(Program, EndsWithTheCodeOfItsBody) {
  EXPECT_EQ(run([](int, char**) { return kExitBadResult; }), kExitBadResult);
}

TEST(Program, ThatThrowsEndsWithASentence) {
  EXPECT_EXIT(_exit(run([](int, char**) -> int { throw std::runtime_error("no memory"); })),
              ExitedWithCode(kExitRetry), "handcast: no memory");
}

TEST(Program, WithAnEmptyArgumentIsNotRun) {
  const auto never = [](int, char**) -> int { throw std::runtime_error("it ran"); };
  EXPECT_EXIT(_exit(run(never, {"up", ""})), ExitedWithCode(kExitUsage), "argument 2 is empty");
}

TEST(Program, WhoseOutputHasNoRoomHasFailed) {
  const auto print = [](int, char**) {
    std::printf("a result\n");
    return kExitDone;
  };
  EXPECT_EXIT(
      {
        if (!std::freopen("/dev/full", "w", stdout)) _exit(99);
        _exit(run(print));
      },
      ExitedWithCode(kExitRetry), "the output cannot be written: No space left");
}

TEST(Program, FindsItsStandardDescriptorsOpenEvenIfItsCallerClosedThem) {
  const auto open_a_file = [](int, char**) { return ::open("/dev/zero", O_RDONLY); };
  EXPECT_EXIT(
      {
        for (int fd = 0; fd < 64; ++fd) ::close(fd);
        _exit(run(open_a_file));
      },
      ExitedWithCode(3), "");
}

TEST(Program, WhoseCallerClosedItsOutputHasFailedIfItPrints) {
  const auto print = [](int, char**) { return std::printf("a result\n") > 0 ? kExitDone : 1; };
  EXPECT_EXIT(
      {
        ::close(STDOUT_FILENO);
        _exit(run(print));
      },
      ExitedWithCode(kExitRetry), "the output cannot be written");
}

TEST(Printable, ShowsWhatWouldMoveTheCursor) {
  EXPECT_EQ(printable("a\x1b[31mb\r\n\tc\x7f é"), "a\\x1b[31mb\\x0d\n\tc\\x7f é");
}

}  // namespace
}  // namespace handcast
