// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "ipc/base/result.hpp"

/// Files that are never lost: what it was is kept beside it, with the time in its name.
namespace handcast::calibrate {

/// Copies a file to a name beside it with the time in it, before another takes its place:
/// rig.2026-11-25T001500.toml. Returns the name. Errors: unavailable (it cannot be copied).
Result<std::filesystem::path> keep_old(const std::filesystem::path& file);

/// Writes the text to the file. If there was one, it is kept as STEM.TIME.EXTENSION. Returns a
/// sentence that says where both are. Errors: unavailable (a file cannot be written).
Result<std::string> write_and_keep(const std::filesystem::path& file, const std::string& text);

/// Says why a kept file cannot be used.
using IsUsable = std::function<Result<void>(const std::filesystem::path&)>;

/// Puts the newest kept file that can be used in the place of the file, which is kept in turn: a
/// second call takes the first one back. Returns a sentence. Errors: bad_config (there is none),
/// unavailable.
Result<std::string> take_back(const std::filesystem::path& file, const IsUsable& is_usable);

}  // namespace handcast::calibrate
