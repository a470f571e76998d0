// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string_view>

#include "ipc/base/result.hpp"
#include "ipc/shm/segment.hpp"

namespace handcast::ipc {

/// Gives another mapping of the ring of a stream of the rig; empty: there is no rig. Any thread.
using OpenRing = std::function<Result<Segment>(std::string_view stream)>;

}  // namespace handcast::ipc
