// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace handcast::supervisor {

/// The state of a service as `handcast status` shows it. ServiceState (service_state.hpp) has the
/// states that the supervisor distinguishes.
enum class State {
  stopped,   ///< stopped on request, or its work is done
  starting,  ///< started and not yet ready, or about to be started (again)
  ready,     ///< the worker works
  stopping,  ///< asked to stop
  degraded,  ///< it dies too often; restarted after long waits
  failed     ///< a person must change something; not restarted
};

/// The names of the states, as status and metrics show them.
inline constexpr std::array<std::string_view, 6> kStateNames{"stopped",  "starting", "ready",
                                                             "stopping", "degraded", "failed"};
/// The name of a state.
constexpr std::string_view name_of(State state) {
  return kStateNames[static_cast<std::size_t>(state)];
}

}  // namespace handcast::supervisor
