// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// The rig that a command is meant for: control::choose_rig(), with a sentence of its own for
/// services that live without their supervisor. Errors: as control::choose_rig().
Result<std::string> choose_rig(const std::string& name);
/// The same, but services that live without their supervisor count as a rig.
Result<std::string> choose_rig_to_stop(const std::string& name);

}  // namespace handcast::supervisor
