// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "supervisor/life/service.hpp"

namespace handcast::supervisor {

/// Runs `handcast-NAME --safe` for a service that did not end by itself, and whose device may
/// therefore be as it left it (ServiceSpec::has_safe_state). Waits for it, at most 3 s.
void leave_safe(const Service& service, const Launch& launch);

}  // namespace handcast::supervisor
