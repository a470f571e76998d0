// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "supervisor/life/service.hpp"

namespace handcast::supervisor {

/// Runs `handcast-NAME --safe` for a service that did not end by itself, and whose device may
/// therefore be as it left it (ServiceSpec::has_safe_state). Waits for it, at most 3 s, and calls
/// `beat` a few times a second meanwhile.
void leave_safe(const Service& service, const Launch& launch, const std::function<void()>& beat);

}  // namespace handcast::supervisor
