// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/types.h>
#include <sys/un.h>

#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/result.hpp"
#include "ipc/base/unique_fd.hpp"

/// How a rig is found by its name. A rig is a listening Unix socket in the abstract namespace
/// (unix(7)), so it has no file that could be removed, be left behind, or fill a disk.
namespace handcast::control {

/// The environment variable that separates the rigs of a test, or of another group of rigs, from
/// the other rigs of the same user.
inline constexpr const char* kScopeVariable = "HANDCAST_SCOPE";

/// The address of a rig's control socket.
struct RigAddress {
  std::string text;      ///< "handcast-UID/SCOPE/RIG"; unique in its network namespace
  sockaddr_un socket{};  ///< the same as a socket address
  socklen_t size = 0;    ///< of the socket address, in bytes
};

/// The address of this user's rig `rig`. Errors: bad_config (it is not a name of a rig, or the
/// scope is too long).
Result<RigAddress> address_of(std::string_view rig);

/// The name of the rig whose address has this text; "" if it is not a rig of this user and scope.
std::string name_in(std::string_view address);

/// The names of this user's rigs that have a supervisor, sorted.
std::vector<std::string> living_rigs();

/// A sentence for each rig of this scope that is up and belongs to another user: whose it is, and
/// how to reach it.
std::vector<std::string> rigs_of_others();

/// True if a process of this user listens at the rig's address, even if it hangs.
bool has_supervisor(const std::string& rig);

/// Connects to a rig's supervisor. Does not wait. Errors: unavailable (no process listens), timeout
/// (the listener does not accept the connection), bad_config (the listener belongs to another
/// user).
Result<UniqueFd> connect_to(const RigAddress& address);

/// True if the process at the other end of a Unix socket belongs to this user.
bool is_of_this_user(int socket);
/// The pid of the process of this user that listens at an address, even if it accepts no
/// connections. -1 if there is none.
pid_t listener_of(const RigAddress& address);

}  // namespace handcast::control
