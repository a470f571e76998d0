// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "ipc/msg/stage_mark.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

/// The stages of a frame: `stages` (Frame::stages), its presentation and its light.
inline std::vector<msg::StageMark> time_sheet(std::span<const msg::StageMark> stages,
                                              const PresentTimes& times) {
  std::vector<msg::StageMark> marks(stages.begin(), stages.end());
  marks.push_back({msg::Stage::present, 0, stages.back().end_ns, times.handed_ns});
  if (times.display_ns > times.handed_ns)
    marks.push_back(
        {msg::Stage::light, msg::detail_of(times.note), times.handed_ns, times.display_ns});
  return marks;
}

}  // namespace handcast::projector
