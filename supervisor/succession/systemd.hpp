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

/// Tells systemd a state, "READY=1\nSTATUS=...", "WATCHDOG=1" or "STOPPING=1": sd_notify's
/// protocol, a datagram to $NOTIFY_SOCKET. Does nothing without systemd.
void notify_systemd(std::string_view state);
/// Gives the rings' memory to systemd to keep (FDSTORE=1, FDNAME=stream): the rings outlive even
/// the last process. Does nothing without systemd.
void store_with_systemd(const std::vector<std::pair<std::string, int>>& rings);
/// Takes what systemd gives back ($LISTEN_FDS, $LISTEN_FDNAMES), by stream. Empty the second time.
std::vector<std::pair<std::string, UniqueFd>> taken_from_systemd();

/// Half of the time after which systemd takes this process to hang ($WATCHDOG_USEC); empty if
/// systemd does not watch it.
std::optional<std::int64_t> watchdog_period_ns();

/// Tells systemd as often as needed that this process lives. Does nothing without systemd.
class Watchdog {
 public:
  Watchdog();
  /// Call it at every turn of the event loop.
  void tick(std::int64_t now_ns);

 private:
  std::optional<std::int64_t> period_ns_;
  std::int64_t next_ns_ = 0;
};

}  // namespace handcast::supervisor
