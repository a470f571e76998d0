// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/control/control_message.hpp"

namespace handcast::supervisor {

/// Asks a rig and waits for its answer's object: as long as the services take, but no longer than
/// its supervisor is awake. Errors: unavailable (it is not up, it went away, it hangs), bad_data
/// (its refusal).
Result<nlohmann::json> ask(const std::string& rig, const Request& request);
/// The same with the descriptors that belong to the answer; what else came is closed. Of a
/// supervisor that has not said anything for the time of `patience` it is taken that it hangs.
Result<Answer> ask_with_descriptors(const std::string& rig, const Request& request,
                                    std::chrono::nanoseconds patience = std::chrono::seconds(10));

}  // namespace handcast::supervisor
