// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "config/sections/process.hpp"
#include "ipc/base/result.hpp"

namespace handcast::service {

/// Gives this process a real-time priority (SCHED_FIFO). Returns why the system denies it; "" if it
/// does not.
std::string try_priority(int priority);

/// Checks whether this machine has the cores of [NAME.process]. Errors: bad_config (it does not).
Result<void> check_scheduling(const config::Process& process, std::string_view service);

/// Applies the cores, the priority and the memory lock of [NAME.process] to this process. Returns a
/// sentence, to be logged, for each setting that the system does not permit. Errors: as
/// check_scheduling().
Result<std::vector<std::string>> apply_scheduling(const config::Process& process,
                                                  std::string_view service);

/// Lets the other services go first where cores are short: lowers the priority of this process. If
/// it leads its session, as a service does, also that of the session: nice(2) counts only within a
/// session where the kernel shares the cores among sessions (autogroup, sched(7)).
void give_way();

}  // namespace handcast::service
