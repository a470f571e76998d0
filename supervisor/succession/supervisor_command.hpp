// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <string>
#include <string_view>
#include <vector>

#include "supervisor/life/keeper_link.hpp"
#include "supervisor/succession/keeper.hpp"

namespace handcast::supervisor {

/// The arguments and the environment with which a keeper starts supervisors. They are built once,
/// so that later starts do not allocate memory.
class SupervisorCommand {
 public:
  /// `report_fd`: the supervisor's end of the socket pair to the keeper (kKeeperVariable).
  SupervisorCommand(const std::vector<std::string>& command, int report_fd) : texts_(command) {
    std::vector<std::string> environment;
    for (char** entry = environ; *entry; ++entry)
      if (!sets(*entry, kKeeperVariable) && !sets(*entry, kSuccessorVariable))
        environment.emplace_back(*entry);
    environment.push_back(fmt::format("{}={}", kKeeperVariable, report_fd));
    texts_.insert(texts_.end(), environment.begin(), environment.end());
    for (std::size_t i = 0; i < texts_.size(); ++i)
      (i < command.size() ? arguments_ : environment_).push_back(texts_[i].data());
    arguments_.push_back(nullptr);
    environment_.insert(environment_.end(), {nullptr, nullptr});  // a place for kSuccessorVariable
  }
  SupervisorCommand(const SupervisorCommand&) = delete;

  /// Tells all later supervisors that they follow one that died.
  void for_a_successor() { environment_[environment_.size() - 2] = successor_.data(); }
  /// The arguments and the environment as execve() takes them.
  /// @{
  char* const* arguments() const { return arguments_.data(); }
  char* const* environment() const { return environment_.data(); }
  /// @}

 private:
  static bool sets(std::string_view entry, std::string_view variable) {
    return entry.starts_with(variable) && entry.substr(variable.size()).starts_with('=');
  }

  std::vector<std::string> texts_;  ///< to which the pointers refer
  std::vector<char*> arguments_, environment_;
  std::string successor_ = fmt::format("{}=1", kSuccessorVariable);
};

}  // namespace handcast::supervisor
