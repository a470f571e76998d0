// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The rig that a command refers to: `name`, or, if that is empty, the only rig that is up. Errors:
/// unavailable (there is no such rig, or there are several; the sentence names the rigs that are
/// up), bad_config (the runtime folder).
Result<std::string> choose_rig(const std::string& name);

}  // namespace handcast::supervisor
