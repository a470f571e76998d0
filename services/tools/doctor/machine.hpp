// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// Examines this computer for a rig: processor, priorities, network, rules for devices, disk.
/// `root`: where /sys, /proc and /etc are, for tests.
std::vector<Finding> examine_machine(const config::Rig& rig,
                                     const std::filesystem::path& root = "/");

}  // namespace handcast::doctor
