// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/reload_plan.hpp"

namespace handcast::supervisor {

/// `handcast reload` as a transaction. begin() plans and checks the new rig. advance() first
/// prepares replacements of the services that work and have to change, one after the other, while
/// the old ones go on. If one cannot be prepared, nothing is changed. Otherwise the new rig is
/// applied as a whole: all replacements take over, and the other services are started, restarted
/// and stopped.
class Reload {
 public:
  /// Begins to apply `wanted`. `revives`: see plan_reload(). `rig` must outlive the result. Errors:
  /// bad_config, unavailable; the rig, its services and the applied rig are unchanged then.
  static Result<Reload> begin(LiveRig& rig, config::Rig wanted, bool revives);

  /// Does the next step. Returns true if the rig was not changed, or all services that the reload
  /// affects have settled. Call it on every tick.
  bool advance(std::int64_t now_ns);
  /// True if the reload changes this service and waits for it.
  bool waits_for(const std::string& service) const;
  /// Removes the stopped services from the rig. Returns the answer to the request.
  nlohmann::json finish();

 private:
  enum class Progress { preparing, prepared, failed };

  Reload(LiveRig& rig, ReloadPlan plan, AppliedRig candidate);
  Progress prepare();
  void prepare(const std::string& service);
  void abandon(const std::string& why);
  void apply(std::int64_t now_ns);
  void begin_what_may(std::int64_t now_ns);
  void note_what_has_settled(std::int64_t now_ns);
  nlohmann::json answer() const;

  LiveRig* rig_;
  ReloadPlan plan_;
  AppliedRig candidate_;               ///< the new rig, for the replacements
  std::vector<std::string> replaced_;  ///< they get a replacement
  std::size_t begun_replacements_ = 0;
  bool applied_ = false;
  std::vector<std::string> waiting_;  ///< not started: their needs have not settled
  std::map<std::string, std::int64_t, std::less<>> begun_;  ///< by when they must have settled
  std::vector<std::string> failures_;                       ///< one sentence for each
};

}  // namespace handcast::supervisor
