// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "ipc/msg/stage_mark.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

/// The stages of a frame: those inside the cascade (Frame::stages), the whole frame, its
/// presentation and its light.
inline std::vector<msg::StageMark> time_sheet(std::span<const msg::StageMark> stages,
                                              std::int64_t begin_ns, std::int64_t drawn_ns,
                                              const PresentTimes& times) {
  std::vector<msg::StageMark> marks;
  for (const auto& mark : stages)
    if (mark.stage < msg::Stage::frame) marks.push_back(mark);
  marks.push_back({msg::Stage::frame, 0, begin_ns, drawn_ns});
  marks.push_back({msg::Stage::present, 0, drawn_ns, times.handed_ns});
  if (times.lit_ns > times.handed_ns)
    marks.push_back({msg::Stage::light, msg::detail_of(times.note), times.handed_ns, times.lit_ns});
  return marks;
}

}  // namespace handcast::projector
