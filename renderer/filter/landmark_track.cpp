// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_track.hpp"

#include <utility>

namespace handcast::renderer {

void LandmarkTrack::tracker_sample(std::int64_t now_ns, PoseHistory::Pushed pushed) {
  if (pushed == PoseHistory::Pushed::not_measured) return;
  has_news_ = true;
  filter_->tracker_sample(now_ns);
}

void LandmarkTrack::detection(std::int64_t now_ns, std::int64_t origin_ns,
                              const msg::HandLandmarks& seen, const HandTrack& track) {
  if (!seen_ns_ || origin_ns > *seen_ns_) seen_ns_ = origin_ns;
  has_news_ = true;
  filter_->detection(
      now_ns, origin_ns, seen, [&track](std::int64_t time_ns) -> std::optional<LandmarkPoints> {
        return time_ns < track.begins_ns() ? std::nullopt : track.recent_landmarks(time_ns);
      });
}

Filtered LandmarkTrack::filter(std::int64_t now_ns, std::int64_t target_ns,
                               const Predicted& predicted) {
  const bool is_silent = predicted.is_silent;
  const bool has_news =
      std::exchange(has_news_, false) || is_silent != std::exchange(was_silent_, is_silent);
  const auto filtered = filter_->at(now_ns, target_ns, predicted.posed.landmarks);
  return {filtered.value_or(predicted.posed.landmarks), filtered.has_value(), has_news,
          filtered ? seen_ns_ : std::nullopt};
}

}  // namespace handcast::renderer
