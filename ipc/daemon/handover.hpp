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

/// What a supervisor hands to a daemon in its environment (contract.hpp). Descriptors are -1 if
/// there is none.
struct Handover {
  Rings rings;
  int ready_fd = -1;
  int standby_fd = -1;                   ///< of a spare
  std::optional<std::int64_t> epoch_ns;  ///< empty for a daemon that was started by hand
};

/// "camera.frames=5,pose.hands=6".
std::string print_rings(const Rings& rings);
/// The reverse. Entries that make no sense are left out.
Rings parse_rings(std::string_view text);
/// The descriptor of a stream; empty if it is not in the list.
std::optional<int> find_ring(const Rings& rings, std::string_view stream);

/// "NAME=value" for each variable that has a value.
std::vector<std::string> to_environment(const Handover& handover);
/// What this process was handed. Values that make no sense count as unset.
Handover from_environment();

}  // namespace handcast::daemon
