// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// The arrows of a trace: per frame of the snapshot the numbers of the flows that pass through it.
/// Three kinds, each from a sensor to the light: an image and every projector frame that showed it;
/// an image, its detection and the first projector frame that knew it; a tracker's sample and the
/// first projector frame that knew it.
std::vector<std::vector<std::uint64_t>> flows_of(const HistorySnapshot& history);

}  // namespace handcast::supervisor
