// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::control {

/// The rig that is meant by `name`: the one of that name, or, if `name` is empty, the one that has
/// started this program, or the only rig that is up. Errors: unavailable (no such rig, or several;
/// the sentence names those that are up).
Result<std::string> choose_rig(const std::string& name);

}  // namespace handcast::control
