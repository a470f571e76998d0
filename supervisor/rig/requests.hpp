// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "supervisor/control/control_server.hpp"
#include "supervisor/rig/changes.hpp"
#include "supervisor/rig/live_rig.hpp"
#include "supervisor/rig/reload.hpp"

namespace handcast::supervisor {

/// Answers what is asked over the control socket (ipc/control/control_message.hpp): at once, or
/// when what was asked for is done.
class Requests {
 public:
  struct Host {
    std::function<Result<config::Rig>()> read_file;  ///< the rig file as it is now
    std::function<void()> stop;                      ///< the rig is to stop
  };
  Requests(LiveRig& rig, Host host);

  void answer(const control::Request& request, ControlServer::Reply reply);
  /// Makes this rig the one that is applied; `revives`: services that have given up are tried
  /// again.
  void reload(Result<config::Rig> wanted, bool revives, ControlServer::Reply reply);
  /// Goes on with a reload. Call it on every tick.
  void tick(std::int64_t now_ns);

  void on_ready(const Service& service) { changes_.on_ready(service); }
  void on_stopped(const Service& service) { changes_.on_stopped(service); }
  /// True: the service was being changed or reloaded, and the rig goes on without it.
  bool on_failed(Service& service);
  /// The rig stops: what was not done by now will not be.
  void on_stopping();
  /// The rig has stopped.
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
  std::optional<Reloading> reloading_;
  std::vector<ControlServer::Reply> waiting_for_stop_;
};

}  // namespace handcast::supervisor
