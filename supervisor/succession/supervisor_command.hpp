// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <vector>

#include "supervisor/life/exit_reports.hpp"
#include "supervisor/succession/keeper.hpp"

namespace handcast::supervisor {

/// The arguments and the environment with which a keeper starts supervisors. They are built once,
/// so that later starts do not allocate memory.
struct SupervisorCommand {
  std::vector<std::string> arguments, environment;
  std::vector<char*> argument_pointers, environment_pointers;
  std::string successor = fmt::format("{}=1", kSuccessorVariable);

  SupervisorCommand(const std::vector<std::string>& command, int report_fd) : arguments(command) {
    for (char** entry = environ; *entry; ++entry) {
      const std::string_view text = *entry;
      if (!text.starts_with(fmt::format("{}=", kKeeperVariable)) &&
          !text.starts_with(fmt::format("{}=", kSuccessorVariable)))
        environment.emplace_back(text);
    }
    environment.push_back(fmt::format("{}={}", kKeeperVariable, report_fd));
    for (auto& text : arguments) argument_pointers.push_back(text.data());
    for (auto& text : environment) environment_pointers.push_back(text.data());
    argument_pointers.push_back(nullptr);
    environment_pointers.insert(environment_pointers.end(),
                                {nullptr, nullptr});  // a place for kSuccessorVariable
  }
  void for_a_successor() {
    environment_pointers[environment_pointers.size() - 2] = successor.data();
  }
};

}  // namespace handcast::supervisor
