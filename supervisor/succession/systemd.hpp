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

/// What systemd is told (sd_notify's protocol, a datagram to $NOTIFY_SOCKET). Without systemd
/// nothing happens.
void notify_systemd(std::string_view state);  ///< "READY=1\nSTATUS=…", "WATCHDOG=1", "STOPPING=1"
/// Gives the rings' memory to systemd to keep (FDSTORE=1, FDNAME=stream), so that they outlive even
/// the last process.
void store_with_systemd(const std::vector<std::pair<std::string, int>>& rings);
/// What systemd gave back ($LISTEN_FDS, $LISTEN_FDNAMES), once.
std::vector<std::pair<std::string, UniqueFd>> taken_from_systemd();

/// Half of the time after which systemd takes this process for hung ($WATCHDOG_USEC); empty where
/// it does not watch.
std::optional<std::int64_t> watchdog_period_ns();

/// Tells systemd as often as it wants to hear it that this process lives. Without systemd nothing
/// happens.
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
