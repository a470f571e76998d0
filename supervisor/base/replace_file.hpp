// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::supervisor {

/// Writes a file that only this user can read, as a whole or not at all. Errors: unavailable.
Result<void> replace_file(const std::filesystem::path& path, const std::string& text);

}  // namespace handcast::supervisor
