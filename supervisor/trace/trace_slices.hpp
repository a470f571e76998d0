// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// One mark on a lane of its service. On a lane, slices lie one behind the other or, those of one
/// frame, one inside the other: what a trace viewer can draw. A service whose frames overlap in
/// time (a sensor that delivers later than its period) gets more lanes.
struct Slice {
  std::size_t frame = 0;  ///< index into the snapshot's frames
  msg::StageMark mark;
};
using Lane = std::vector<Slice>;  ///< by begin; what encloses others comes before them

/// The lanes of every service of the snapshot, in the order of its services; each has at least one.
std::vector<std::vector<Lane>> lanes_of(const HistorySnapshot& history);

}  // namespace handcast::supervisor
