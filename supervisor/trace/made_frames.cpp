// SPDX-License-Identifier: Apache-2.0
#include "supervisor/trace/made_frames.hpp"

#include <algorithm>

namespace handcast::supervisor {
namespace {

struct Event {
  std::int64_t time_ns;
  std::size_t index;
};

/// The frames that have a mark of this stage, by the time at which it began or ended.
std::vector<Event> events(const HistorySnapshot& history, msg::Stage stage,
                          std::int64_t msg::StageMark::*time) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < history.frames.size(); ++i)
    if (const auto* mark = find_mark(history.frames[i], stage)) events.push_back({mark->*time, i});
  std::ranges::stable_sort(events, {}, &Event::time_ns);
  return events;
}

/// Goes through events in the order of their times.
class Newest {
 public:
  explicit Newest(std::vector<Event> events) : events_(std::move(events)) {}
  std::optional<std::size_t> at(std::int64_t time_ns) {
    for (; next_ < events_.size() && events_[next_].time_ns <= time_ns; ++next_)
      newest_ = events_[next_].index;
    return newest_;
  }

 private:
  std::vector<Event> events_;
  std::size_t next_ = 0;
  std::optional<std::size_t> newest_;
};

}  // namespace

const msg::StageMark* find_mark(const FrameRecord& frame, msg::Stage stage) {
  const auto found = std::ranges::find(frame.marks, stage, &msg::StageMark::stage);
  return found == frame.marks.end() ? nullptr : &*found;
}

const msg::StageMark* find_light(const FrameRecord& frame) {
  const auto* light = find_mark(frame, msg::Stage::light);
  return light ? light : find_mark(frame, msg::Stage::present);
}

std::optional<std::int64_t> age_of(const FrameRecord& frame, const msg::StageMark& mark) {
  const auto origin_ns = frame.header.origin_ns;
  if (origin_ns <= 0 || origin_ns > mark.end_ns) return std::nullopt;
  return mark.end_ns - origin_ns;
}

Images::Images(const HistorySnapshot& history) {
  for (std::size_t i = 0; i < history.frames.size(); ++i) {
    const auto& frame = history.frames[i];
    if (find_mark(frame, msg::Stage::capture))
      sorted_.push_back({frame.header.origin_ns, frame.header.frame_id, i});
  }
  std::ranges::sort(sorted_);
}

std::optional<std::size_t> Images::of(const msg::Header& derived) const {
  const auto found =
      std::ranges::lower_bound(sorted_, Image{derived.origin_ns, derived.frame_id, 0});
  const bool same = found != sorted_.end() && found->origin_ns == derived.origin_ns &&
                    found->frame_id == derived.frame_id;
  return same ? std::optional(found->index) : std::nullopt;
}

std::vector<MadeFrame> made_frames(const HistorySnapshot& history) {
  using msg::Stage, msg::StageMark;
  const Images images(history);
  Newest detections(events(history, Stage::detect, &StageMark::end_ns));
  Newest samples(events(history, Stage::sample, &StageMark::end_ns));
  std::vector<MadeFrame> made;
  for (const auto& [begin_ns, index] : events(history, Stage::frame, &StageMark::begin_ns))
    made.push_back({index, images.of(history.frames[index].header), detections.at(begin_ns),
                    samples.at(begin_ns)});
  return made;
}

}  // namespace handcast::supervisor
