// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/un.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Where living rigs are found: ${XDG_RUNTIME_DIR:-/tmp}/handcast-UID, made if need be, for this
/// user alone. Errors: bad_config where the folder is not ours or others may enter it.
Result<std::filesystem::path> runtime_folder();

/// The control socket of a rig. Errors: bad_config for a name that cannot be part of a path, or
/// makes it too long.
Result<std::filesystem::path> socket_of(std::string_view rig);

/// The rigs of this user that are up, in the order of their names.
Result<std::vector<std::string>> living_rigs();

/// A connection to the control socket at `path`, to a process of this user. Waits for nobody.
/// Errors: unavailable (nobody listens there), timeout (somebody does, but lets nobody in),
/// bad_config (it is another user's).
Result<UniqueFd> connect_to(const std::filesystem::path& path);

/// Whether the process at the other end of a Unix socket is of this user.
bool is_of_this_user(int socket);

/// Writes a file of the runtime folder for this user alone, whole or not at all. Errors:
/// unavailable.
Result<void> replace_file(const std::filesystem::path& path, const std::string& text);

sockaddr_un address_of(const std::filesystem::path& path);

}  // namespace handcast::supervisor
