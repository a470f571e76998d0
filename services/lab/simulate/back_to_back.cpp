// SPDX-License-Identifier: Apache-2.0
#include "services/lab/simulate/back_to_back.hpp"

#include <algorithm>

namespace handcast::simulate {

void BackToBack::until(std::int64_t now_ns, std::vector<SensorEvent>& events) {
  waiting_.insert(waiting_.end(), events.begin(), events.end());
  while (true) {
    if (!under_way_) {
      const auto frame = next_frame(now_ns);
      const auto begin_ns = std::max(free_ns_, twin_.camera_arrival_ns(frame));
      if (begin_ns > now_ns) return;
      under_way_ = begin(frame, begin_ns);
    }
    if (under_way_->done_ns > now_ns) return;
    if (under_way_->landmarks) events.push_back({under_way_->done_ns, *under_way_->landmarks});
    free_ns_ = under_way_->done_ns;
    under_way_.reset();
  }
}

/// The frame of the next run, or one that arrives after `now_ns`.
std::uint64_t BackToBack::next_frame(std::int64_t now_ns) const {
  auto next = static_cast<std::uint64_t>(last_frame_ + 1);
  while (twin_.camera_lost(next) && twin_.camera_arrival_ns(next) <= now_ns) ++next;
  for (auto frame = next + 1; twin_.camera_arrival_ns(frame) <= free_ns_; ++frame)
    if (!twin_.camera_lost(frame)) next = frame;
  return next;
}

BackToBack::Run BackToBack::begin(std::uint64_t frame, std::int64_t begin_ns) {
  tell(begin_ns);
  const Exposure exposure{frame, twin_.camera_origin_ns(frame), twin_.camera_stamp_ns(frame)};
  const auto detection = detector_->detect(runs_++, exposure);
  if (on_detection_) on_detection_(exposure, detection);
  last_frame_ = static_cast<std::int64_t>(frame);
  return {std::max(exposure.origin_ns + detection.age_ns, begin_ns), detection.landmarks};
}

/// Passes on the samples that have arrived when a run begins, and no later ones.
void BackToBack::tell(std::int64_t begin_ns) {
  const auto later = std::ranges::find_if(
      waiting_, [&](const SensorEvent& event) { return event.arrival_ns > begin_ns; });
  for (auto event = waiting_.begin(); event != later; ++event)
    if (const auto* poses = std::get_if<msg::HandPoses>(&event->message)) detector_->tell(*poses);
  waiting_.erase(waiting_.begin(), later);
}

}  // namespace handcast::simulate
