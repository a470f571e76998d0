// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace handcast::supervisor {

/// What `handcast status` calls the state of a service. What the supervisor itself distinguishes is
/// in service_state.hpp.
enum class State {
  stopped,   ///< as asked, or its work is done
  starting,  ///< started and not ready, or about to be started (again)
  ready,
  stopping,
  degraded,  ///< dies too often; retried slowly
  failed     ///< a person must change something; not retried
};

inline constexpr std::array<std::string_view, 6> kStateNames{"stopped",  "starting", "ready",
                                                             "stopping", "degraded", "failed"};
constexpr std::string_view name_of(State state) {
  return kStateNames[static_cast<std::size_t>(state)];
}

}  // namespace handcast::supervisor
