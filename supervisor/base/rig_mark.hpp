// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace handcast::supervisor {

/// The rig of a service, as the service's command line shows it to everybody. The kernel hides
/// environment and descriptors of a process with capabilities (setcap, AmbientCapabilities=) from
/// other processes of its user, but not its command line.
struct RigMark {
  std::string address;        ///< HANDCAST_RIG
  std::int64_t epoch_ns = 0;  ///< HANDCAST_EPOCH_NS
  std::uint64_t network = 0;  ///< inode of the network namespace, in which the address is unique
};

/// The network namespace of this process; 0 if it is unknown.
std::uint64_t own_network();

/// The text of a mark: "4026531840:123456789:handcast-1000//desk".
std::string print_mark(const RigMark& mark);

/// The mark in a command line as /proc/PID/cmdline shows it. Empty if it has none.
std::optional<RigMark> mark_in(std::string_view command_line);

}  // namespace handcast::supervisor
