// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/frame_assembler.hpp"

#include <algorithm>

namespace handcast::camera::leap {

FrameAssembler::FrameAssembler(std::size_t frame_bytes, std::uint32_t split_ticks)
    : frame_bytes_(frame_bytes), split_ticks_(split_ticks), bytes_(frame_bytes) {}

FrameAssembler::Ended FrameAssembler::take(std::span<const std::uint8_t> payload,
                                           std::int64_t arrived_ns) {
  const auto parsed = parse_payload(payload);
  if (!parsed) {
    ++strays_;
    lose_payload();
    return {};
  }
  Ended ended;
  if (!is_open_ && is_behind_its_end(*parsed)) {
    ++strays_;
    return ended;
  }
  if (is_open_ && is_of_another_frame(*parsed)) ended.torn = end(false);
  if (!is_open_) begin(*parsed, arrived_ns);
  append(*parsed, arrived_ns);
  if (parsed->ends_frame) ended.own = end(true);
  return ended;
}

void FrameAssembler::lose_payload() { is_broken_ = is_open_; }

bool FrameAssembler::is_of_another_frame(const Payload& payload) const {
  if (payload.frame_id != frame_.frame_id) return true;
  if (split_ticks_ == 0 || !payload.stamp || !last_stamp_) return false;
  return *payload.stamp - *last_stamp_ >= split_ticks_;
}

/// Without stamps, a payload with image bytes may be the first of the image after a lost one.
bool FrameAssembler::is_behind_its_end(const Payload& payload) const {
  if (!has_ended_ || is_of_another_frame(payload)) return false;
  return payload.data.empty() || (split_ticks_ > 0 && payload.stamp && last_stamp_);
}

void FrameAssembler::begin(const Payload& payload, std::int64_t arrived_ns) {
  bytes_.resize(frame_bytes_);
  filled_ = 0;
  is_open_ = true;
  is_broken_ = false;
  frame_ = {.frame_id = payload.frame_id, .stamp = payload.stamp, .first_ns = arrived_ns};
}

void FrameAssembler::append(const Payload& payload, std::int64_t arrived_ns) {
  if (payload.stamp) last_stamp_ = payload.stamp;
  frame_.last_ns = arrived_ns;
  is_broken_ = is_broken_ || payload.has_error || payload.data.size() > frame_bytes_ - filled_;
  if (is_broken_) return;
  std::ranges::copy(payload.data, bytes_.begin() + static_cast<std::ptrdiff_t>(filled_));
  filled_ += payload.data.size();
}

EndedFrame FrameAssembler::end(bool with_mark) {
  frame_.is_whole = with_mark && !is_broken_ && filled_ == frame_bytes_;
  is_open_ = is_broken_ = false;
  has_ended_ = true;
  return frame_;
}

}  // namespace handcast::camera::leap
