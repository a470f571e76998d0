// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>

#include "supervisor/control/control_server.hpp"
#include "supervisor/rig/live_rig.hpp"

namespace handcast::supervisor {

/// The restarts and swaps of single services that were asked for. Each is answered when the service
/// is ready again, or will not be. A swap whose back end does not start is taken back.
class Changes {
 public:
  explicit Changes(LiveRig& rig) : rig_(rig) {}

  void restart(Service& service, ControlServer::Reply reply);
  /// `word`: a back end, maybe by its old name. Refuses one that the service does not have.
  void swap(Service& service, const std::string& word, ControlServer::Reply reply);

  bool contains(std::string_view service) const { return pending_.contains(service); }
  /// A service that is being changed; "" if there is none.
  std::string any() const { return pending_.empty() ? "" : pending_.begin()->first; }

  void on_ready(const Service& service);
  void on_stopped(const Service& service);
  /// True: a swap is taken back, the service goes on with its old back end.
  bool on_failed(Service& service);
  void refuse_all(const std::string& sentence);

 private:
  struct Pending {
    ControlServer::Reply reply;
    std::string wanted{}, before{};  ///< back ends; "" for a plain restart
    std::string reason{};            ///< why `wanted` did not start; "" while it is tried
  };
  void give_backend(Service& service, const std::string& backend, bool on_trial);

  LiveRig& rig_;
  std::map<std::string, Pending, std::less<>> pending_;  ///< by service
};

}  // namespace handcast::supervisor
