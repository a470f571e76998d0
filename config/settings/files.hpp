// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// The contents of a text file. Errors: bad_config (see read_input()).
Result<std::string> read_text(const std::filesystem::path& file);

/// Writes a file by replacing it, so that a reader never sees a part of it. A link or device
/// (/dev/stdout) is written in place. Errors: unavailable (the file cannot be written), those of
/// check_output().
Result<void> write_whole(const std::filesystem::path& file, const std::string& text);
/// Checks before long work whether write_whole() is likely to succeed. Errors: bad_config (it is
/// not).
Result<void> check_writable(const std::filesystem::path& file);

}  // namespace handcast::config
