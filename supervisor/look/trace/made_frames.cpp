// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/made_frames.hpp"

#include <algorithm>

namespace handcast::supervisor {
namespace {

/// The frames of the projector in the order of their begin.
std::vector<std::size_t> projector_frames(const HistorySnapshot& history) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < history.frames.size(); ++i)
    if (find_mark(history.frames[i], msg::Stage::frame)) frames.push_back(i);
  std::ranges::stable_sort(frames, {}, [&](std::size_t i) {
    return find_mark(history.frames[i], msg::Stage::frame)->begin_ns;
  });
  return frames;
}

}  // namespace

const msg::StageMark* find_mark(const FrameRecord& frame, msg::Stage stage) {
  const auto found = std::ranges::find(frame.marks, stage, &msg::StageMark::stage);
  return found == frame.marks.end() ? nullptr : &*found;
}

const msg::StageMark* find_light(const FrameRecord& frame) {
  const auto* light = find_mark(frame, msg::Stage::light);
  return light ? light : find_mark(frame, msg::Stage::present);
}

std::optional<std::int64_t> age_of(std::int64_t origin_ns, const msg::StageMark& mark) {
  if (origin_ns <= 0 || origin_ns > mark.end_ns) return std::nullopt;
  return mark.end_ns - origin_ns;
}

Records::Records(const HistorySnapshot& history, msg::Stage stage) {
  for (std::size_t i = 0; i < history.frames.size(); ++i) {
    const auto& frame = history.frames[i];
    if (find_mark(frame, stage))
      sorted_.push_back({frame.header.origin_ns, frame.header.frame_id, i});
  }
  std::ranges::sort(sorted_);
}

std::optional<std::size_t> Records::of(std::int64_t origin_ns,
                                       std::optional<std::uint64_t> frame_id) const {
  if (origin_ns <= 0) return std::nullopt;
  const auto found = std::ranges::lower_bound(sorted_, Record{origin_ns, frame_id.value_or(0), 0});
  const bool is_it = found != sorted_.end() && found->origin_ns == origin_ns &&
                     (!frame_id || found->frame_id == *frame_id);
  return is_it ? std::optional(found->index) : std::nullopt;
}

std::vector<MadeFrame> made_frames(const HistorySnapshot& history) {
  const Records images(history, msg::Stage::capture), samples(history, msg::Stage::sample),
      detections(history, msg::Stage::detect);
  std::vector<MadeFrame> made;
  for (const std::size_t i : projector_frames(history)) {
    const auto& from = history.frames[i].made_from;
    made.push_back({i, images.of(from.image_ns, from.image_id), detections.of(from.landmarks_ns),
                    samples.of(from.pose_ns)});
  }
  return made;
}

}  // namespace handcast::supervisor
