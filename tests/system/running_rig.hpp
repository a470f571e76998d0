// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/scratch.hpp"
#include "tests/system/command.hpp"

namespace handcast::system_test {

/// A scope and a folder for the rigs of one test.
class SystemTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override { kill_all_of(scratch_.path()); }

  /// The result of a command.
  struct Outcome {
    int exit_code = 0;
    std::string output, log;
  };
  /// Runs `handcast ARGUMENTS...` to its end.
  Outcome handcast(const Arguments& arguments) const;

  /// `handcast up` of the twin at rates that do not overload the machine, with the arguments
  /// `more`.
  std::unique_ptr<Command> up(const Arguments& more = {}) const;
  /// Waits until every service is ready and light flows.
  void wait_until_light() const;

  nlohmann::json status() const;  ///< status of the only rig; null if none answers
  nlohmann::json service(const std::string& name) const { return status()["services"][name]; }
  std::uint64_t light() const;  ///< frames projected so far
  void expect_more_light() const;
  std::vector<pid_t> pids() const;
  /// Shared memory and processes that a rig has left behind.
  std::vector<std::string> traces() const;

  test::Scratch scratch_;
};

inline const std::vector<std::string> kServices{"camera",  "pose", "landmarks", "projector",
                                                "content", "desk", "observer"};

/// The last line of a text.
std::string last_line(const std::string& text);

}  // namespace handcast::system_test
