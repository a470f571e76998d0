// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// The findings in what `handcast config --check` printed: its sentences, a line each, after the
/// line with the name of the file.
std::vector<Finding> judge_check(int exit_code, const std::string& complaints);

/// What `handcast up` would refuse of a rig file with these settings of --set, asked from
/// `handcast config --check` in the folder of this program. One good finding if it would not.
std::vector<Finding> examine_start(const std::string& file,
                                   const std::vector<std::string>& settings);

}  // namespace handcast::doctor
