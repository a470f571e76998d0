// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "ipc/msg/projection.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/writer.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "services/projector/projector.hpp"

namespace handcast::projector {

/// Writes a projected frame to a message that is followed by `tail_bytes` for pixels. A region that
/// does not fit is left out. `frame_id` is counted by the projector.
void write_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                      const PresentTimes& times, msg::Projection& projection,
                      std::size_t tail_bytes);

/// Publishes a projected frame; drops it if readers hold all slots of the ring.
void publish_projection(const renderer::Frame& frame, std::uint64_t frame_id,
                        const PresentTimes& times, ipc::Writer<msg::Projection>& projections);

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
