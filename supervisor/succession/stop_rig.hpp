// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// How stop_rig() ended a rig.
struct StopReport {
  bool by_supervisor = false;  ///< its supervisor stopped it
  int ended = 0;               ///< number of processes that had to be ended without the supervisor
};

/// A sentence about a rig that has stopped. If no process had to be ended, it stopped by itself,
/// even if its supervisor did not answer any more.
std::string describe(const StopReport& report, const std::string& name);

/// Stops a rig, whatever state it is in, and checks in /proc that no service is left: asks its
/// supervisor; if that does not answer for about a second, or there is none, asks its keeper; then
/// kills both and ends the services. The light is off within 5 s, unless supervisor.stop_s is
/// longer. Errors: unavailable (something is left, or another supervisor starts again and again),
/// bad_config (the name; another user has it).
Result<StopReport> stop_rig(const std::string& name);

}  // namespace handcast::supervisor
