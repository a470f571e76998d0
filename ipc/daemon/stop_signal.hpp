// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::daemon {

/// From now on SIGTERM and SIGINT only raise a flag (blocking calls return EINTR), and SIGPIPE is
/// ignored.
void install_stop_signals();
/// Whether the flag is up. Safe from any thread.
bool stop_requested();

}  // namespace handcast::daemon
