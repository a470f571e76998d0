// SPDX-License-Identifier: Apache-2.0
#include "services/projector/sub_frame_messages.hpp"

#include <cstring>
#include <limits>

#include "services/projector/publish.hpp"

namespace handcast::projector {

void SubFrameMessages::keep(const renderer::Frame& frame, int count, const msg::FrameDelay& delay) {
  if (kept_ == drawings_.size()) drawings_.emplace_back();
  Drawing& drawing = drawings_[kept_++];
  const std::size_t bytes = msg::Projection::bytes(static_cast<std::size_t>(frame.region.width()),
                                                   static_cast<std::size_t>(frame.region.height()));
  drawing.message.resize(bytes / sizeof(std::uint64_t) + 1);
  auto& message = *new (drawing.message.data()) msg::Projection;
  write_projection(frame, 0, {}, message, bytes - sizeof message);
  drawing.stages.assign(frame.stages.begin(), frame.stages.end());
  drawing.delay = delay;
  drawing.count = count;
}

void SubFrameMessages::handed_over(const SubFramePlan& plan, std::uint64_t first_id,
                                   const PresentTimes& times) {
  while (next_ < sub_frames_.size()) publish_next();
  std::swap(drawings_, lit_);
  sub_frames_.clear();
  for (std::size_t i = 0; i < kept_; ++i)
    for (int of_drawing = 0; of_drawing < lit_[i].count; ++of_drawing)
      sub_frames_.push_back(
          {i, of_drawing == 0, plan.times_of(static_cast<int>(sub_frames_.size()), times)});
  first_id_ = first_id;
  kept_ = next_ = 0;
}

std::int64_t SubFrameMessages::due_ns() const {
  return next_ < sub_frames_.size() ? sub_frames_[next_].times.handed_ns
                                    : std::numeric_limits<std::int64_t>::max();
}

void SubFrameMessages::publish(std::int64_t time_ns) {
  while (due_ns() <= time_ns) publish_next();
}

void SubFrameMessages::publish_next() {
  const SubFrame& sub_frame = sub_frames_[next_];
  const Drawing& drawing = lit_[sub_frame.drawing];
  const auto& kept = *reinterpret_cast<const msg::Projection*>(drawing.message.data());
  const std::uint64_t id = first_id_ + next_++;
  if (auto slot = projections_.loan();
      slot && kept.used_bytes() <= sizeof kept + slot.tail_bytes()) {
    std::memcpy(static_cast<void*>(&*slot), &kept, kept.used_bytes());
    slot->header.frame_id = id;
    slot->lit_ns = sub_frame.times.display_ns;
    projections_.publish(std::move(slot));
  }
  if (sub_frame.is_first)
    mark_({id, kept.made_from.image_ns}, TimeSheet(drawing.stages, sub_frame.times, drawing.delay),
          kept.made_from);
}

}  // namespace handcast::projector
