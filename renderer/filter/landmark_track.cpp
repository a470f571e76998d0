// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/landmark_track.hpp"

#include <utility>

namespace handcast::renderer {
namespace {

constexpr int kSeenAgain = 2;  ///< detections until a tracker that returns is used again

}  // namespace

void LandmarkTrack::tracker_sample(std::int64_t now_ns, PoseHistory::Pushed pushed) {
  if (pushed == PoseHistory::Pushed::not_measured) return;
  if (pushed == PoseHistory::Pushed::begins_anew) filter_->tracker_jumped();
  has_news_ = true;
  filter_->tracker_sample(now_ns);
}

void LandmarkTrack::detection(std::int64_t now_ns, std::int64_t origin_ns,
                              const msg::HandLandmarks& seen, const HandTrack& track) {
  if (!seen_ns_ || origin_ns > *seen_ns_) seen_ns_ = origin_ns;
  ++seen_again_;
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
  if (is_silent) seen_again_ = 0;
  is_alone_ = is_silent || (is_alone_ && seen_again_ < kSeenAgain);

  filter_->tracker_is(is_silent ? LandmarkFilter::Tracker::silent
                                : LandmarkFilter::Tracker::reporting);
  const auto filtered = filter_->at(now_ns, target_ns, predicted.posed.landmarks);
  const LandmarkPoints landmarks = filtered.value_or(predicted.posed.landmarks);
  moved_px_ = difference(landmarks, predicted.posed.landmarks);
  return {landmarks, filtered.has_value(), is_alone_, has_news, filtered ? seen_ns_ : std::nullopt};
}

std::optional<LandmarkPoints> LandmarkTrack::expected_at(std::int64_t time_ns,
                                                         const HandTrack& track) const {
  const auto points = track.recent_landmarks(time_ns);
  return points ? std::optional(sum(*points, moved_px_)) : std::nullopt;
}

}  // namespace handcast::renderer
