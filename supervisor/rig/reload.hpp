// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/reload_plan.hpp"

namespace handcast::supervisor {

/// `handcast reload` as a transaction: plan, check and apply (begin), then settle (advance). What
/// cannot be applied is not applied at all; from there on nothing can fail but a service.
class Reload {
 public:
  /// Makes `wanted` the rig that is applied. Errors: bad_config, unavailable; then the rig, its
  /// services and the applied file are as they were.
  static Result<Reload> begin(LiveRig& rig, config::Rig wanted, bool revives);

  /// Restarts and starts what may begin by now. True when everything that the reload touched has
  /// settled. Call it on every tick.
  bool advance(std::int64_t now_ns);
  /// Whether the reload has begun this service and waits for it.
  bool waits_for(const std::string& service) const { return begun_.contains(service); }
  /// Takes the services that have stopped from the rig. Returns the answer for the person.
  nlohmann::json finish();

 private:
  Reload(LiveRig& rig, ReloadPlan plan);
  void apply();
  void begin_what_may(std::int64_t now_ns);
  void note_what_has_settled(std::int64_t now_ns);

  LiveRig* rig_;
  ReloadPlan plan_;
  std::vector<std::string> waiting_;  ///< not begun: what they need has not settled
  std::map<std::string, std::int64_t, std::less<>> begun_;  ///< until when they must have settled
  std::vector<std::string> failures_;                       ///< a sentence each
};

}  // namespace handcast::supervisor
