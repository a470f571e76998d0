// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace handcast::daemon {

/// Streams and the descriptors of their rings' segments.
using Rings = std::vector<std::pair<std::string, int>>;

/// The values that a supervisor passes to a daemon in its environment (contract.hpp). A descriptor
/// is -1 if there is none.
struct Handover {
  Rings rings;                           ///< HANDCAST_RINGS
  int ready_fd = -1;                     ///< HANDCAST_READY_FD
  int standby_fd = -1;                   ///< HANDCAST_STANDBY_FD, only for a standby
  std::optional<std::int64_t> epoch_ns;  ///< empty for a daemon that was started by hand
  std::string rig;                       ///< HANDCAST_RIG; "" for a daemon started by hand
  int state_fd = -1;                     ///< HANDCAST_STATE_FD
};

/// "camera.frames=5,pose.hands=6".
std::string print_rings(const Rings& rings);
/// The reverse. Invalid entries are left out.
Rings parse_rings(std::string_view text);
/// The descriptor of a stream; empty if it is not in the list.
std::optional<int> find_ring(const Rings& rings, std::string_view stream);

/// "NAME=value" for each variable that has a value.
std::vector<std::string> to_environment(const Handover& handover);
/// The handover in the environment of this process. Invalid values count as unset.
Handover from_environment();

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

}  // namespace handcast::daemon
