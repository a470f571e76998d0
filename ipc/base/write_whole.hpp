// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string_view>

#include "ipc/base/result.hpp"

namespace handcast {

/// Whether a file that was written outlasts a power cut. It takes some milliseconds, which matter
/// for thousands of pictures.
enum class Durable { no, yes };

/// Writes a file by replacing it: readers, and the disk after an error, have all of the old bytes
/// or all of the new ones. The new ones are first written beside it, under a hidden name that no
/// other file has and that is removed on every error. Links are followed. The file keeps its
/// permissions and, as far as this process may set it, its owner. A device, and a file that is the
/// standard output or error of this process, are written in place. Every file that a person may
/// have had before is written here. Errors: unavailable (the file or its folder cannot be written,
/// or the disk is full), those of check_output(); the sentence names the file.
Result<void> write_whole(const std::filesystem::path& file, std::string_view bytes,
                         Durable durable = Durable::yes);

/// Checks before long work whether write_whole() is likely to succeed. Errors: bad_config (it is
/// not).
Result<void> check_writable(const std::filesystem::path& file);
/// The same of a result, which must not replace a rig file that was named by mistake. Errors:
/// bad_config (also: it is a TOML file that exists).
Result<void> check_result_file(const std::filesystem::path& file);

}  // namespace handcast
