// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/sections/process.hpp"
#include "ipc/base/result.hpp"

namespace handcast::service {

/// Runs this process on the cores, at the priority and in locked memory as its section says. What
/// the system does not permit is left as it is: the notes are one sentence each, to be logged.
/// Errors: bad_config (cores that this machine does not have).
Result<std::vector<std::string>> apply_scheduling(const config::Process& process,
                                                  std::string_view service);

}  // namespace handcast::service
