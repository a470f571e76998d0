// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/un.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

/// The folder with the rigs of a user. For each rig it holds RIG.sock (the control socket),
/// RIG.toml (the applied rig file) and RIG.state (the state for a successor of the supervisor).
namespace handcast::control {

/// The folder ${XDG_RUNTIME_DIR:-/tmp}/handcast-UID, which is created if it is missing. Errors:
/// bad_config (it belongs to another user, or others have access to it).
Result<std::filesystem::path> runtime_folder();

/// The path of a rig's control socket. Errors: bad_config (the name cannot be part of a path, or
/// the path is too long), or those of runtime_folder().
Result<std::filesystem::path> socket_of(std::string_view rig);

/// The names of this user's rigs that are up, sorted. Errors: those of runtime_folder().
Result<std::vector<std::string>> living_rigs();

/// Connects to the control socket at `path`. Does not wait. Errors: unavailable (no process
/// listens), timeout (the listener does not accept the connection), bad_config (the listener
/// belongs to another user).
Result<UniqueFd> connect_to(const std::filesystem::path& path);

/// True if the process at the other end of a Unix socket belongs to this user.
bool is_of_this_user(int socket);

/// The address of a Unix socket at a path.
sockaddr_un address_of(const std::filesystem::path& path);

}  // namespace handcast::control
