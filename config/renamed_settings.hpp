// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/settings/renamed.hpp"

namespace handcast::config {

/// The settings of rig files that are written another way now.
std::span<const Renamed> renamed_settings();

/// Logs a sentence about an old form as a warning.
void log_renamed(const std::string& sentence);

}  // namespace handcast::config
