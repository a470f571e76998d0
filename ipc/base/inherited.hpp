// SPDX-License-Identifier: Apache-2.0
// What a program inherits from the shell or the service manager that starts it.
#pragma once
#include <string>
#include <vector>

namespace handcast::inherited {

/// True if the caller wants this signal to be ignored: SIGHUP under nohup(1), SIGINT of a program
/// that a script starts in the background.
bool is_ignored(int signal);

/// True if the descriptor is a terminal that understands control sequences; not TERM=dumb.
bool is_terminal(int fd);

/// The message of an error number, and the limit of this process that may be its reason.
std::string reason_of(int error);

/// A sentence for each limit (ulimit) that is too low for a rig, and for a umask that takes the
/// owner's rights.
std::vector<std::string> obstacles();

}  // namespace handcast::inherited
