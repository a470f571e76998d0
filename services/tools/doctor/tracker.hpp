// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <vector>

#include "config/rig.hpp"
#include "services/tools/doctor/finding.hpp"

namespace handcast::doctor {

/// Whether a tracker's software may be asked: a runtime may serve one program at a time.
enum class Asking {
  now,      ///< the rig is not up
  not_now,  ///< the rig is using it
};

/// Examines the tracker of a rig, and the second one: whether its software is installed, its device
/// attached, and whether it answers. No findings for the twin's tracker, recordings, and none.
/// `root`: where /sys and /usr are, for tests.
std::vector<Finding> examine_tracker(const config::Rig& rig, Asking asking,
                                     const std::filesystem::path& root = "/");

}  // namespace handcast::doctor
