// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/control/rig_address.hpp"
#include "supervisor/life/child.hpp"
#include "tests/supervisor/scope_scratch.hpp"

namespace handcast::supervisor {

/// Services of the rig "desk" that no supervisor knows of.
class Orphans : public testing::Test {
 protected:
  /// `words`: those after the script on its command line.
  Child& service(const std::string& script, std::int64_t epoch_ns = now_ns(),
                 const std::vector<std::string>& words = {}) {
    std::vector<std::string> arguments{"-c", script};
    arguments.insert(arguments.end(), words.begin(), words.end());
    auto child = Child::spawn({.program = "/bin/bash",
                               .arguments = std::move(arguments),
                               .epoch_ns = epoch_ns,
                               .rig = control::address_of("desk").value().text,
                               .state_fd = 2});
    EXPECT_TRUE(child);
    children_.push_back(std::make_unique<Child>(std::move(*child)));
    return *children_.back();
  }
  /// A service that ignores SIGTERM.
  Child& deaf_service() {
    auto& child = service("trap '' TERM; echo up; while :; do sleep 0.02; done");
    char byte = 0;
    while (read(child.log_fd(), &byte, 1) != 1) usleep(1000);  // until it ignores the signal
    return child;
  }

  ScopeScratch scratch_;
  std::vector<std::unique_ptr<Child>> children_;
};

}  // namespace handcast::supervisor
