#pragma once
#include <string>

#include "ipc/base/result.hpp"
#include "supervisor/control_message.hpp"

namespace handcast::supervisor {

/// The rig to talk to: `name`, or where it is empty the only one that is up. Errors: unavailable, with who is up.
Result<std::string> choose_rig(const std::string& name);

/// Asks a rig and waits for its answer's object. Errors: unavailable (it is not up, it went away), bad_data (its refusal).
Result<nlohmann::json> ask(const std::string& rig, const Request& request);

}  // namespace handcast::supervisor
