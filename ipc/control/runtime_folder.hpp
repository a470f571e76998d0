// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/un.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

/// The folder in which the rigs of a user are found. Of each rig it holds RIG.sock (the control
/// socket), RIG.toml (the rig as it is applied) and RIG.state (what a successor of the supervisor
/// needs).
namespace handcast::control {

/// The folder ${XDG_RUNTIME_DIR:-/tmp}/handcast-UID, which is made if it is missing. Errors:
/// bad_config (it belongs to another user, or others may enter it).
Result<std::filesystem::path> runtime_folder();

/// The path of a rig's control socket. Errors: bad_config (the name cannot be part of a path, or
/// makes it too long), or as runtime_folder().
Result<std::filesystem::path> socket_of(std::string_view rig);

/// The names of this user's rigs that are up, sorted. Errors: as runtime_folder().
Result<std::vector<std::string>> living_rigs();

/// A connection to the control socket at `path`. Does not wait. Errors: unavailable (nobody
/// listens), timeout (somebody listens and accepts no connection), bad_config (the listener is
/// another user's process).
Result<UniqueFd> connect_to(const std::filesystem::path& path);

/// Whether the process at the other end of a Unix socket belongs to this user.
bool is_of_this_user(int socket);

/// The address of a Unix socket at a path.
sockaddr_un address_of(const std::filesystem::path& path);

}  // namespace handcast::control
