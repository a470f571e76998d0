// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>

#include "ipc/base/result.hpp"

namespace handcast {

/// The path with the folder of a user in place of a leading ~ or ~USER, as a shell does it. Others
/// stay, also one that a shell would have to look into first ("$HOME/a.png"): see odd_path().
/// Errors: bad_config (there is no such user, or the own one has no folder).
Result<std::string> expand_home(const std::string& path);

/// What is wrong with the writing of a path that was meant for a shell, a file manager or Windows:
/// "$HOME/a.png", "file:///a.png", "C:\a.png". A sentence with the remedy; "" if nothing is.
std::string odd_path(const std::string& path);
/// What is wrong with a path, seen from a folder, as it is written; "" if nothing is, if it is
/// absolute, or if there is such a file.
std::string fault_of_path(const std::string& path, const std::filesystem::path& folder);

/// The folder for what a program remembers from one run to the next: handcast/ in
/// $STATE_DIRECTORY (a systemd service), $XDG_STATE_HOME or ~/.local/state. Made if there is none.
/// Errors: unavailable.
Result<std::filesystem::path> state_folder();

}  // namespace handcast
