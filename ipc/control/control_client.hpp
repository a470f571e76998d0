// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/control/control_message.hpp"

namespace handcast::control {

/// Sends a request to a rig and waits for the answer: as long as the services take, but only while
/// the supervisor is awake. Errors: unavailable (the rig is not up, it went away, its supervisor
/// hangs), bad_data (the rig refused; the sentence is its own).
Result<nlohmann::json> ask(const std::string& rig, const Request& request);
/// The same, with the descriptors that belong to the answer; all others are closed. A supervisor
/// that sends nothing for the time of `patience` is taken to hang.
Result<Answer> ask_with_descriptors(const std::string& rig, const Request& request,
                                    std::chrono::nanoseconds patience = std::chrono::seconds(10));
/// The rig file as it was applied, with the back ends that were swapped, as TOML. Waits at most 2 s
/// for a supervisor that hangs. Errors: those of ask(); bad_data (the answer has no rig file).
Result<std::string> ask_for_rig(const std::string& rig);

}  // namespace handcast::control
