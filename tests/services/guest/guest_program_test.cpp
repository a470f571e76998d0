// SPDX-License-Identifier: Apache-2.0
#include "services/guest/guest_program.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "tests/scratch.hpp"

namespace handcast::guest {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

class GuestProgramTest : public testing::Test {
 protected:
  config::External shell(const std::string& script) const {
    return {.command = {"sh", "-c", script}, .folder = folder_.path()};
  }
  /// How it ends, within a minute.
  static std::string end_of(GuestProgram& program) {
    for (const auto limit = Deadline::in(60s); !limit.passed();) {
      program.pass_on_output(Deadline::in(10ms));
      if (auto end = program.end()) return *end;
    }
    return "it goes on";
  }
  std::string result(const config::External& settings) const {
    auto program = GuestProgram::start(settings);
    return program ? end_of(*program) : program.error().what;
  }
  /// The text of a file, once the program has written it.
  std::string text_of(const std::string& name) const {
    std::string text;
    for (const auto limit = Deadline::in(60s); text.empty() && !limit.passed();)
      std::getline(std::ifstream(folder_.path() / name), text);
    return text;
  }
  const test::Scratch folder_;
};

TEST_F(GuestProgramTest, ItsEndIsDescribedWithItsLastLine) {
  EXPECT_EQ(result(shell("echo a; echo 'no camera' >&2; exit 3")), "exit 3: no camera");
  EXPECT_EQ(result(shell("exit 0")), "exit 0");
  EXPECT_THAT(result(shell("kill -SEGV $$")), HasSubstr("signal 11"));
}

TEST_F(GuestProgramTest, OneThatIsNotThereIsASentence) {
  auto absent = shell("");
  absent.command = {"no_such_program"};
  EXPECT_THAT(result(absent), AllOf(HasSubstr("no_such_program"), HasSubstr("No such file")));
  EXPECT_FALSE(check_command(absent));
  auto elsewhere = shell("exit 0");
  elsewhere.folder = "/no/such/folder";
  EXPECT_THAT(result(elsewhere), HasSubstr("/no/such/folder"));
  const auto found = check_command(elsewhere);
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().what, HasSubstr("no folder '/no/such/folder'"));
}

TEST_F(GuestProgramTest, ItRunsInItsFolder) {
  std::ofstream(folder_.path() / "mine") << "#!/bin/sh\necho \"$1\"\n";
  std::filesystem::permissions(folder_.path() / "mine", std::filesystem::perms::owner_all);
  const config::External mine{.command = {"./mine", "two words"}, .folder = folder_.path()};
  EXPECT_TRUE(check_command(mine));
  EXPECT_EQ(result(mine), "exit 0: two words");
}

TEST_F(GuestProgramTest, OneThatDoesNotStopIsKilled) {
  auto program = GuestProgram::start(
      shell("trap '' TERM; echo hangs; echo $$ >pid; while :; do sleep 1; done"));
  ASSERT_TRUE(program);
  const auto pid = static_cast<pid_t>(std::stoi(text_of("pid")));
  EXPECT_EQ(kill(pid, 0), 0);
  program->stop(Deadline::in(100ms));
  EXPECT_NE(kill(pid, 0), 0);
  EXPECT_EQ(program->last_line(), "hangs");
}

TEST_F(GuestProgramTest, WhatItHasStartedEndsWithIt) {
  auto program = GuestProgram::start(shell("sleep 1000 & echo $! > worker; exit 0"));
  ASSERT_TRUE(program) << program.error().what;
  const auto worker = std::stoi(text_of("worker"));
  EXPECT_EQ(end_of(*program), "exit 0");
  const auto is_alive = [&] {
    std::string state;
    std::getline(std::ifstream("/proc/" + std::to_string(worker) + "/stat"), state);
    return !state.empty() && state.find(") Z ") == std::string::npos;
  };
  for (const auto limit = Deadline::in(60s); is_alive() && !limit.passed();) usleep(10'000);
  EXPECT_FALSE(is_alive());
}

TEST_F(GuestProgramTest, OneThatPrintsWithoutEndCannotKeepItsReader) {
  auto program = GuestProgram::start({.command = {"yes"}, .folder = folder_.path()});
  ASSERT_TRUE(program);
  program->pass_on_output(Deadline::in(100ms));
  EXPECT_FALSE(program->end());
}

TEST_F(GuestProgramTest, ItDoesNotOutliveTheProcessThatStartedIt) {
  const auto watcher = fork();
  if (watcher == 0) {
    auto program = GuestProgram::start(shell("echo $$ >pid; exec sleep 1000"));
    pause();
    _exit(0);
  }
  const auto pid = static_cast<pid_t>(std::stoi(text_of("pid")));
  kill(watcher, SIGKILL);
  waitpid(watcher, nullptr, 0);
  const auto limit = Deadline::in(60s);
  while (kill(pid, 0) == 0 && !limit.passed()) sleep_until_ns(now_ns() + to_ns(1ms));
  EXPECT_NE(kill(pid, 0), 0);
}

TEST_F(GuestProgramTest, ItHasNoDescriptorsOfTheRig) {
  const UniqueFd ring(::open(folder_.path().c_str(), O_RDONLY | O_DIRECTORY));  // inheritable
  const auto look =
      shell("for i in 3 4 5 6 7 8 9 10 11 12; do [ -e /proc/$$/fd/$i ] && echo $i; done; :");
  EXPECT_EQ(result(look), "exit 0");
}

}  // namespace
}  // namespace handcast::guest
