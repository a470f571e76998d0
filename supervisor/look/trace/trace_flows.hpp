// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "supervisor/record/history.hpp"

namespace handcast::supervisor {

/// The flows (arrows) of a trace: for each frame of the snapshot the numbers of the flows through
/// it. A flow connects
/// - an image and all projector frames made from it;
/// - an image, its detection and the first projector frame made from that detection;
/// - a tracker sample and the first projector frame made from it.
std::vector<std::vector<std::uint64_t>> flows_of(const HistorySnapshot& history);

}  // namespace handcast::supervisor
