// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::landmarks {

/// The folder of the networks' files from outside. The first of these counts:
///  1. `configured` (the setting landmarks.models), if it is not empty;
///  2. HANDCAST_MODELS, if it is set;
///  3. share/handcast/models of the installation, if it exists;
///  4. handcast/models in $XDG_DATA_HOME or ~/.local/share, the default of scripts/get-models.
/// Errors: bad_config (`configured` is not a folder).
Result<std::filesystem::path> models_folder(const std::string& configured);

}  // namespace handcast::landmarks
