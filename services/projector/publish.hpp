// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>

#include "ipc/msg/frame_delay.hpp"
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

/// The stages of a frame: `stages` (Frame::stages), whose mark of the whole frame gets the delay,
/// its presentation and its light. A value that allocates nothing.
class TimeSheet {
 public:
  TimeSheet(std::span<const msg::StageMark> stages, const PresentTimes& times,
            const msg::FrameDelay& delay = {}) {
    for (auto mark : stages) {
      if (mark.stage == msg::Stage::frame) mark.detail = msg::detail_of(delay);
      add(mark);
    }
    add({msg::Stage::present, 0, stages.back().end_ns, times.handed_ns});
    if (times.display_ns > times.handed_ns)
      add({msg::Stage::light, msg::detail_of(times.note), times.handed_ns, times.display_ns});
  }
  /// The marks in their order.
  operator std::span<const msg::StageMark>() const { return std::span(marks_).first(count_); }

 private:
  /// A mark for which a message has no room is left out.
  void add(const msg::StageMark& mark) {
    if (count_ < marks_.size()) marks_[count_++] = mark;
  }

  decltype(msg::StageMarks::marks) marks_;
  std::size_t count_ = 0;
};

}  // namespace handcast::projector
