// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// The contents of a text file. Errors: bad_config (see read_input()).
Result<std::string> read_text(const std::filesystem::path& file);

}  // namespace handcast::config
