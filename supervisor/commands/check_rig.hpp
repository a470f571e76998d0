// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "config/rig.hpp"

namespace handcast::supervisor {

/// What `up` would refuse about a rig that was read from `file` with these settings of --set: a
/// sentence for each fault. Asks the program of each service (`handcast-NAME --check`), which opens
/// what the rig names.
std::vector<std::string> faults_of(const config::Rig& rig, const std::filesystem::path& file,
                                   const std::vector<std::string>& settings);

}  // namespace handcast::supervisor
