// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// One mark on a lane of its service. The slices of a lane follow each other or, if they belong to
/// one frame, are nested, as a trace viewer requires. A service whose frames overlap in time (a
/// sensor whose images arrive later than its period) gets several lanes.
struct Slice {
  std::size_t frame = 0;  ///< index into HistorySnapshot::frames
  msg::StageMark mark;    ///< the stage and its time
};
/// Slices in the order of their begin; a slice comes before those nested in it.
using Lane = std::vector<Slice>;

/// The lanes of all services, in the order of HistorySnapshot::services; each service has at least
/// one lane.
std::vector<std::vector<Lane>> lanes_of(const HistorySnapshot& history);

}  // namespace handcast::supervisor
