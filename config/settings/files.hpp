// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast::config {

/// The text of a file. Errors (bad_config): it cannot be read, and why.
Result<std::string> read_text(const std::filesystem::path& file);

/// Writes a file so that a reader never sees half of it; what is no plain file (a link, a pipe,
/// /dev/stdout) is written in place. Errors: unavailable.
Result<void> write_whole(const std::filesystem::path& file, const std::string& text);
/// Whether write_whole is likely to succeed, to be asked before long work. Errors: bad_config.
Result<void> check_writable(const std::filesystem::path& file);

}  // namespace handcast::config
