// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "supervisor/control/control_server.hpp"
#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/reload.hpp"

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
  /// Replaces the services whose replacements are prepared, and gives up waiting for those that do
  /// not get ready, e.g. without their device: they go on trying. Call it on every tick.
  void tick(std::int64_t now_ns);

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
    std::int64_t until_ns = 0;       ///< by when the service must be ready if it is not replaced
  };
  using All = std::map<std::string, Pending, std::less<>>;

  bool is_replacing(const Service& service) const;
  void replace(Service& service, const std::string& backend, Pending& pending);
  void hand_over(Service& service, Pending& pending);
  void give_backend(Service& service, const std::string& backend, bool on_trial);

  LiveRig& rig_;
  All pending_;  ///< by service
};

/// Carries out the requests of the control socket (ipc/control/control_message.hpp). Each is
/// answered when it is done, or when it has failed.
class Requests {
 public:
  /// Functions of the rig that requests call.
  struct Host {
    std::function<Result<config::Rig>()> read_file;  ///< reads the rig file
    std::function<void()> stop;                      ///< begins to stop the rig
    std::filesystem::path rig_file;  ///< absolute; for programs that write beside it
  };
  /// `rig` must outlive the object.
  Requests(LiveRig& rig, Host host);

  /// Carries out a request.
  void answer(const control::Request& request, ControlServer::Reply reply);
  /// Reloads the rig. `wanted`: the new rig, or why it cannot be read. `revives`: see
  /// plan_reload().
  void reload(Result<config::Rig> wanted, bool revives, ControlServer::Reply reply);
  /// Continues changes and reloads. Call it on every tick.
  void tick(std::int64_t now_ns);

  /// Must be called at each Notice of a service. on_failed() returns true if the failure belongs to
  /// a pending request; it must not stop the rig then.
  /// @{
  void on_ready(const Service& service) { changes_.on_ready(service); }
  void on_stopped(const Service& service) { changes_.on_stopped(service); }
  bool on_failed(Service& service);
  /// @}
  /// Must be called when the rig begins to stop: answers pending changes and reloads with a
  /// failure.
  void on_stopping();
  /// Must be called when the rig has stopped: answers the requests to stop it.
  void on_done();

 private:
  void change(const control::Request& request, ControlServer::Reply reply);
  std::string why_not_reload() const;
  std::string why_not_change(const control::Request& request) const;

  struct Reloading {
    Reload reload;
    ControlServer::Reply reply;
  };

  LiveRig& rig_;
  Host host_;
  Changes changes_;
  std::unique_ptr<Reloading> reloading_;  ///< null if none goes on
  std::vector<ControlServer::Reply> waiting_for_stop_;
};

}  // namespace handcast::supervisor
