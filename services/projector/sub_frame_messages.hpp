// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "ipc/msg/frame_delay.hpp"
#include "ipc/msg/projection.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/writer.hpp"
#include "renderer/pipeline/frame.hpp"
#include "services/projector/projector.hpp"
#include "services/projector/sub_frame_plan.hpp"

namespace handcast::projector {

/// Publishes the sub-frames of an output frame, a message for each with the time of its own light:
/// not before the output frame is handed over, because only then the light is known, and each as
/// long before its light as the first one. A drawing that is lit in several sub-frames is published
/// for each of them, and its stages only for the first. One thread.
class SubFrameMessages {
 public:
  /// Takes the stages of a drawn sub-frame: service::Context::mark().
  using Mark = std::function<void(const msg::Header&, std::span<const msg::StageMark>,
                                  const msg::MadeFrom&)>;

  /// Writes to the ring projection.frames.
  SubFrameMessages(ipc::Writer<msg::Projection> projections, Mark mark)
      : projections_(std::move(projections)), mark_(std::move(mark)) {}

  /// Keeps a copy of a drawing of the output frame that is being drawn. `delay`: of its drawing.
  void keep(const renderer::Frame& frame, int count, const msg::FrameDelay& delay = {});
  /// The last drawing is lit in `count` more sub-frames.
  void extend(int count) { drawings_[kept_ - 1].count += count; }
  /// The output frame was handed over as `times` say; the ids of its sub-frames begin with
  /// `first_id`. Publishes what is left of the one before.
  void handed_over(const SubFramePlan& plan, std::uint64_t first_id, const PresentTimes& times);
  /// Drops the output frame that is being drawn: it was not shown.
  void drop() { kept_ = 0; }

  /// When publish() has a message again; very late if there is none.
  std::int64_t due_ns() const;
  /// Publishes the messages that are due at `time_ns`.
  void publish(std::int64_t time_ns);

 private:
  struct Drawing {
    std::vector<std::uint64_t> message;  ///< the bytes of a msg::Projection
    std::vector<msg::StageMark> stages;
    msg::FrameDelay delay;
    int count = 0;
  };
  /// One message of the output frame that is lit.
  struct SubFrame {
    std::size_t drawing = 0;
    bool is_first = false;  ///< of its drawing
    PresentTimes times;
  };
  void publish_next();

  ipc::Writer<msg::Projection> projections_;
  Mark mark_;
  std::vector<Drawing> drawings_, lit_;  ///< memory is reused
  std::size_t kept_ = 0;                 ///< the valid drawings_
  std::vector<SubFrame> sub_frames_;     ///< of lit_
  std::size_t next_ = 0;                 ///< the first one that is not published
  std::uint64_t first_id_ = 0;
};

}  // namespace handcast::projector
