// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ipc/base/clock.hpp"
#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/daemon/handover.hpp"

namespace handcast::daemon {

/// A daemon's side of the contract with its supervisor (contract.hpp). A daemon that was started by
/// hand has no supervisor: it is no standby, and what it says goes nowhere. One thread.
class Supervision {
 public:
  /// Takes over what the environment hands to this process. `name` is the daemon's: "camera".
  static Supervision from_environment(std::string name);

  /// The time of the rig's start (CLOCK_MONOTONIC). If the daemon was started by hand: when this
  /// object was made.
  std::int64_t epoch_ns() const { return epoch_ns_; }

  /// A new descriptor of a ring's segment. Errors: bad_config (the ring was not handed over),
  /// unavailable.
  Result<UniqueFd> ring(std::string_view stream) const;
  /// Whether a ring was handed over.
  bool has_ring(std::string_view stream) const;

  /// Whether this process is a standby whose turn has not come.
  bool is_standby() const { return static_cast<bool>(turn_); }
  /// Waits for the turn of a standby, and says meanwhile that it is prepared. Returns at once if
  /// this is no standby. Ends the process with exit 0 on SIGTERM or SIGINT, and if the supervisor
  /// is gone.
  void await_turn();
  /// Until when to wait for what the process that this one replaces still holds: a writer lock, a
  /// port. The supervisor kills a process that does not stop within `stop_s`. In the past if this
  /// process was no standby.
  Deadline predecessor_leaves_by(double stop_s) const;
  /// Tells the supervisor that the daemon works, once.
  void tell_ready();

  /// Whether a heart-beat is due.
  bool beat_is_due(std::int64_t now_ns) const;
  /// Call it whenever something is published in the ring of the stage marks.
  void note_beat(std::int64_t now_ns) { last_beat_ns_ = now_ns; }

 private:
  Supervision(std::string name, Handover handover);

  std::string name_;
  Rings rings_;
  std::int64_t epoch_ns_ = 0;
  UniqueFd ready_;                       ///< closed when the supervisor has been told
  UniqueFd turn_;                        ///< of a standby whose turn has not come
  std::optional<std::int64_t> turn_ns_;  ///< when the turn of a standby came
  std::int64_t last_beat_ns_ = 0;
};

}  // namespace handcast::daemon
