// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>

#include "ipc/base/result.hpp"

/// Files that are never lost: what it was is kept beside it, with a number in its name.
namespace handcast::calibrate {

/// The time of now where this computer is, as strftime() prints it.
std::string local_time(const char* format);

/// Writes the text to the file. If there was one, it is kept as STEM.NUMBER-TIME.EXTENSION,
/// rig.0003-2026-11-25T001500Z.toml. The number orders the versions; the time (UTC) is for people,
/// because clocks go back. The number is above those of all versions and above `above`: with the
/// newest_number() of several files it is the same for all of them, so that what was changed
/// together is taken back together. Returns the names of both: "rig.toml; the one before it is kept
/// as ...". Errors: unavailable (a file cannot be written).
Result<std::string> write_and_keep(const std::filesystem::path& file, const std::string& text,
                                   int above = 0);

/// The number of the newest kept version of these files; 0 if none is kept.
int newest_number(std::initializer_list<std::filesystem::path> files);

/// Says why a kept file cannot be used.
using IsUsable = std::function<Result<void>(const std::filesystem::path&)>;

/// Puts the newest kept file that can be used in the place of the file, which is kept in turn: a
/// second call takes the first one back. Returns a sentence. Errors: bad_config (there is none),
/// unavailable.
Result<std::string> take_back(const std::filesystem::path& file, const IsUsable& is_usable);

}  // namespace handcast::calibrate
