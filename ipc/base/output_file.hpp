// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/stat.h>

#include <filesystem>

#include "ipc/base/result.hpp"

namespace handcast {

/// Checks that a file may be written: it does not exist, is a regular file or a character device,
/// or is the standard output or error of this process. A pipe, folder or socket is refused, because
/// opening it may block. Errors: bad_config, with a sentence that begins with the path.
Result<void> check_output(const std::filesystem::path& file);

/// True if a file is the standard output or error of this process.
bool is_standard_output(const struct stat& status);

}  // namespace handcast
