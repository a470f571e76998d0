// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// What would blank, lock or suspend the computer while light comes from a window. None for other
/// outputs. `root`: where /proc and /etc are, for tests.
std::vector<Finding> examine_display(const config::Rig& rig,
                                     const std::filesystem::path& root = "/");

}  // namespace handcast::doctor
