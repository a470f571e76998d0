// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "services/watch/day.hpp"

namespace handcast::watch {

/// What the watch reads of the answer to `handcast status`.
struct RigStatus {
  struct Service {
    std::string state;   ///< as the supervisor names it: "ready", "degraded", "failed", …
    std::string reason;  ///< why it is not well, or how it ended last; "" if nobody knows
    int restarts = 0;
    double uptime_s = 0;
  };
  std::map<std::string, Service> services;
  std::map<std::string, std::uint64_t> messages;  ///< number of messages by ring
  std::optional<Drift> drift;                     ///< empty: it is not measured
};

/// What has another type is left out: the supervisor may be of another version.
RigStatus status_in(const nlohmann::json& status);

}  // namespace handcast::watch
