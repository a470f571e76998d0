// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace handcast::service {

/// From now on SIGTERM and SIGINT only raise a flag (blocking calls return EINTR) and SIGPIPE is
/// ignored.
void install_stop_signals();
bool stop_requested();

}  // namespace handcast::service
