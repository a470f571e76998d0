// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/studies/base/study_table.hpp"
#include "tests/display_server.hpp"
#include "tests/scratch.hpp"

extern char** environ;

namespace handcast::study {

using namespace std::chrono_literals;

/// A shell command that is killed at the end.
class Running {
 public:
  explicit Running(std::string command) {
    char* const arguments[] = {const_cast<char*>("sh"), const_cast<char*>("-c"), command.data(),
                               nullptr};
    EXPECT_EQ(::posix_spawn(&pid_, "/bin/sh", nullptr, nullptr, arguments, environ), 0);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  /// The exit code, if it has ended by itself.
  std::optional<int> exit_code() {
    int status = 0;
    if (pid_ > 0 && ::waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = 0;
      exit_code_ = WEXITSTATUS(status);
    }
    return exit_code_;
  }

 private:
  pid_t pid_ = 0;
  std::optional<int> exit_code_;
};

/// `handcast study jnd` on an X server of its own.
class Screen : public testing::Test {
 protected:
  static constexpr auto kPatience = 60s;

  void SetUp() override {
    if (!display_) GTEST_SKIP() << test::DisplayServer::why();
  }
  std::string command(const std::string& arguments = "--answers-by-model") const {
    return fmt::format(
        "exec {}/handcast-study jnd {} --window --size 320x240 "
        "--px-per-mm 0.9 --interval-s 0.2 --rate-hz 10 {} >>{}/out 2>&1",
        std::getenv("HANDCAST_BIN"), scratch_.path().string(), arguments, scratch_.path().string());
  }
  /// Kills the study when its log has so many rows. Where it gives up, because this computer is too
  /// busy for its pictures, it is begun again.
  void study_until(std::size_t rows) const {
    for (const auto end = Deadline::in(kPatience); log().rows.size() < rows && !end.passed();)
      for (Running study(command());
           log().rows.size() < rows && !study.exit_code() && !end.passed();)
        std::this_thread::sleep_for(20ms);
  }
  StudyTable log() const {
    return read_study_table(scratch_.path() / "subject-01.csv").value_or(StudyTable());
  }
  std::string said() const {
    std::ifstream file(scratch_.path() / "out");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  test::DisplayServer display_;
  test::Scratch scratch_;
};

}  // namespace handcast::study
