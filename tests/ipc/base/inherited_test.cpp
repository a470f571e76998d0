// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/inherited.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "ipc/base/unique_fd.hpp"

namespace handcast::inherited {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

TEST(Inherited, ASignalThatTheCallerIgnoresIsKnown) {
  EXPECT_FALSE(is_ignored(SIGHUP));
  const auto before = std::signal(SIGHUP, SIG_IGN);
  EXPECT_TRUE(is_ignored(SIGHUP));
  std::signal(SIGHUP, before);
}

TEST(Inherited, ADumbTerminalGetsNoControlSequences) {
  const UniqueFd terminal(posix_openpt(O_RDWR | O_NOCTTY));
  if (!terminal) GTEST_SKIP() << "no pseudo-terminal can be opened";
  const char* before = getenv("TERM");
  const std::string kept = before ? before : "";
  setenv("TERM", "xterm", 1);
  EXPECT_TRUE(is_terminal(terminal.get()));
  EXPECT_FALSE(is_terminal(UniqueFd(::open("/dev/null", O_RDWR)).get()));
  setenv("TERM", "dumb", 1);
  EXPECT_FALSE(is_terminal(terminal.get()));
  unsetenv("TERM");
  EXPECT_FALSE(is_terminal(terminal.get()));
  if (before) setenv("TERM", kept.c_str(), 1);
}

TEST(Inherited, ALimitIsNamedBeforeItHurtsAndWhenItDoes) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{5'000'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const auto warned = obstacles();
  const auto reason = reason_of(EFBIG);
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(warned, Contains(AllOf(HasSubstr("5 MB"), HasSubstr("ulimit -f"))));
  EXPECT_THAT(reason, AllOf(HasSubstr("File too large"), HasSubstr("5 MB"), HasSubstr("ulimit")));
  if (before.rlim_cur == RLIM_INFINITY) {
    EXPECT_THAT(obstacles(), Not(Contains(HasSubstr("ulimit -f"))));
    EXPECT_THAT(reason_of(EFBIG), Not(HasSubstr("ulimit")));
  }
}

TEST(Inherited, AMaskThatTakesTheOwnersRightsIsNamed) {
  const auto before = ::umask(0277);
  const auto warned = obstacles();
  ::umask(before);
  EXPECT_THAT(warned, Contains(HasSubstr("umask 0277")));
}

}  // namespace
}  // namespace handcast::inherited
