// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "supervisor/control/control_server.hpp"
#include "supervisor/rig/changes.hpp"
#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/reload.hpp"

namespace handcast::supervisor {

/// Carries out the requests of the control socket (ipc/control/control_message.hpp). Each is
/// answered when it is done, or when it has failed.
class Requests {
 public:
  /// Functions of the rig that requests call.
  struct Host {
    std::function<Result<config::Rig>()> read_file;  ///< reads the rig file
    std::function<void()> stop;                      ///< begins to stop the rig
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
