// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// A living process of a service, as /proc shows it.
struct FoundProcess {
  std::string rig;            ///< name of its rig
  std::string service;        ///< of an instance its name, else that of its program
  pid_t pid = 0;              ///< its pid
  UniqueFd pidfd;             ///< readable when it has ended
  std::int64_t epoch_ns = 0;  ///< start of its rig
  int state_fd = -1;          ///< number of its descriptor of the StateMemory; -1: unknown
};

/// The processes of this user's services, of all rigs or of the rig `name`, whoever started them:
/// those with kRigVariable in their environment that lead a session, and those whose environment
/// is hidden and whose command line has a RigMark. Also finds standbys, and services that no
/// supervisor knows of.
/// @{
std::vector<FoundProcess> find_services();
std::vector<FoundProcess> find_services(const std::string& name);
/// @}

/// Sends SIGTERM to the processes of a rig's services, and SIGKILL to those that have not ended
/// after `patience_s`. Looks again until none is found. Leaves a rig of the same name alone that
/// was started after `before_ns`. Returns the number of processes that were found.
int end_services(const std::string& name, double patience_s, std::int64_t before_ns);

}  // namespace handcast::supervisor
