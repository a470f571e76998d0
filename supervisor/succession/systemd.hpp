// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Sends a state to systemd: "READY=1\nSTATUS=...", "WATCHDOG=1" or "STOPPING=1", as a datagram to
/// $NOTIFY_SOCKET (sd_notify(3)). Does nothing without systemd.
void notify_systemd(std::string_view state);
/// Stores the memory of the rings with systemd (FDSTORE=1, FDNAME=stream), so that the rings
/// outlive all processes of the rig. Does nothing without systemd.
void store_with_systemd(const std::vector<std::pair<std::string, int>>& rings);
/// Takes the descriptors that systemd has stored ($LISTEN_FDS, $LISTEN_FDNAMES), by stream, and
/// unsets the variables: a second call returns none.
std::vector<std::pair<std::string, UniqueFd>> taken_from_systemd();
/// The period of the watchdog messages to systemd: half of $WATCHDOG_USEC. Empty if systemd's
/// watchdog is off.
std::optional<std::int64_t> watchdog_period_ns();

/// Sends the watchdog messages to systemd. Does nothing without systemd.
class Watchdog {
 public:
  /// Reads the period from the environment.
  Watchdog();
  /// Sends a message if one is due. Call it at each tick of the event loop.
  void tick(std::int64_t now_ns);

 private:
  std::optional<std::int64_t> period_ns_;
  std::int64_t next_ns_ = 0;
};

}  // namespace handcast::supervisor
