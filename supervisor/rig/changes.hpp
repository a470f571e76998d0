// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "supervisor/control/control_server.hpp"
#include "supervisor/rig/live_rig.hpp"

namespace handcast::supervisor {

/// The pending restarts and swaps of single services. A service that works is replaced: its
/// replacement is prepared while it goes on, and takes over when it is prepared; if it cannot be
/// prepared, nothing has changed. A service that does not work is stopped and started. Each change
/// is answered when the service is ready again, stops or fails. If the new back end of a swap does
/// not start, the old one is restored.
class Changes {
 public:
  /// `rig` must outlive the object.
  explicit Changes(LiveRig& rig) : rig_(rig) {}

  /// Restarts a service.
  void restart(Service& service, ControlServer::Reply reply);
  /// Restarts a service with another back end. Refuses one that the service does not have.
  void swap(Service& service, const std::string& backend, ControlServer::Reply reply);
  /// Replaces the services whose replacements are prepared. Call it on every tick.
  void tick();

  /// True if the service is being changed.
  bool contains(std::string_view service) const { return pending_.contains(service); }
  /// A service that is being changed; "" if there is none.
  std::string any() const { return pending_.empty() ? "" : pending_.begin()->first; }

  /// Must be called at each Notice of a service. They do nothing if it is not being changed.
  /// on_failed() returns true if the service goes on all the same: with the old back end of a swap,
  /// or with its replacement.
  /// @{
  void on_ready(const Service& service);
  void on_stopped(const Service& service);
  bool on_failed(Service& service);
  /// @}
  /// Answers all pending changes with a failure.
  void refuse_all(const std::string& sentence);

 private:
  struct Pending {
    ControlServer::Reply reply;
    std::string wanted{}, before{};  ///< back ends; "" for a restart
    bool is_replacing = false;       ///< the worker goes on; its replacement is being prepared
    std::string reason{};            ///< why `wanted` did not start; "" if it has not failed
  };
  using All = std::map<std::string, Pending, std::less<>>;

  bool is_replacing(const Service& service) const;
  void replace(Service& service, const std::string& backend, Pending& pending);
  void hand_over(Service& service, Pending& pending);
  void give_backend(Service& service, const std::string& backend, bool on_trial);

  LiveRig& rig_;
  All pending_;  ///< by service
};

}  // namespace handcast::supervisor
