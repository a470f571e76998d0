// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/reload_plan.hpp"

namespace handcast::supervisor {

/// `handcast reload` as a transaction: begin() plans, checks and applies the new rig as a whole or
/// not at all; advance() restarts the services.
class Reload {
 public:
  /// Applies `wanted`. `revives`: see plan_reload(). `rig` must outlive the result. Errors:
  /// bad_config, unavailable; the rig, its services and the applied rig are unchanged then.
  static Result<Reload> begin(LiveRig& rig, config::Rig wanted, bool revives);

  /// Starts and restarts the services whose needs have settled. Returns true if all services that
  /// the reload affects have settled. Call it on every tick.
  bool advance(std::int64_t now_ns);
  /// True if the reload has started this service and waits for it.
  bool waits_for(const std::string& service) const { return begun_.contains(service); }
  /// Removes the stopped services from the rig. Returns the answer to the request.
  nlohmann::json finish();

 private:
  Reload(LiveRig& rig, ReloadPlan plan);
  void apply();
  void begin_what_may(std::int64_t now_ns);
  void note_what_has_settled(std::int64_t now_ns);

  LiveRig* rig_;
  ReloadPlan plan_;
  std::vector<std::string> waiting_;  ///< not started: their needs have not settled
  std::map<std::string, std::int64_t, std::less<>> begun_;  ///< by when they must have settled
  std::vector<std::string> failures_;                       ///< one sentence for each
};

}  // namespace handcast::supervisor
