// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::pose::openxr {

/// The extensions without which a runtime is of no use.
std::array<const char*, 3> needed_extensions();

/// Loads the active runtime and looks whether it has them. `runtime`: its name, for people. Errors:
/// unavailable (it cannot be loaded), bad_config (it lacks one, and what that means).
Result<void> check_extensions(const std::string& runtime);

}  // namespace handcast::pose::openxr
