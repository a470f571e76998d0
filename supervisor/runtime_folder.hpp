#pragma once
#include <sys/un.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast::supervisor {

/// Where living rigs are found: ${XDG_RUNTIME_DIR:-/tmp}/handcast-UID, made if need be, for this user alone.
/// Errors: bad_config where the folder is not ours or others may enter it.
Result<std::filesystem::path> runtime_folder();

/// The control socket of a rig. Errors: bad_config for a name that cannot be part of a path, or makes it too long.
Result<std::filesystem::path> socket_of(std::string_view rig);

/// The rigs of this user that answer, in the order of their names.
Result<std::vector<std::string>> living_rigs();

/// A connection to the control socket at `path`. Errors: unavailable (nobody listens there).
Result<UniqueFd> connect_to(const std::filesystem::path& path);

sockaddr_un address_of(const std::filesystem::path& path);

}  // namespace handcast::supervisor
