// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::daemon {

/// What the stop signals ask for.
enum class Stop {
  none,      ///< no signal has arrived
  for_good,  ///< SIGINT: no other process takes over, so the daemon may end its work first
  at_once,   ///< SIGTERM, or a second signal
};

/// From now on SIGTERM and SIGINT are only noted (blocking calls return EINTR), and SIGPIPE is
/// ignored. One that the caller of the program wants to be ignored stays so.
void install_stop_signals();
/// What the signals so far ask for. Safe from any thread.
Stop requested_stop();
/// Whether a stop signal has arrived. Safe from any thread.
inline bool stop_requested() { return requested_stop() != Stop::none; }

}  // namespace handcast::daemon
