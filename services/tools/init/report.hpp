// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "services/tools/init/interview.hpp"

namespace handcast::init {

/// The devices that cannot be used now, and why, where there is no other of their kind; a line
/// each.
std::string troubles_of(const std::vector<devices::Attached>& attached);

/// What was chosen, what is missing, and what to do next, for the person. `file`: the rig file that
/// was written.
std::string report(const Plan& plan, const std::filesystem::path& file);

}  // namespace handcast::init
