// SPDX-License-Identifier: Apache-2.0
#include "renderer/filter/offset_filter.hpp"

#include <algorithm>

namespace handcast::renderer {
namespace {

constexpr double kAloneStartSpeed2 = 1e6;  ///< (px/s)^2; a hand may be moving when it is first seen
constexpr std::int64_t kFresh_ns = 80'000'000;

}  // namespace

LandmarksAlone::LandmarksAlone(const config::Filter& settings)
    : model_{settings.motion_process, settings.noise_px, kAloneStartSpeed2} {}

void LandmarksAlone::detection(std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  if (origin_ns - newest_ns_ > kFresh_ns) forget();
  newest_ns_ = std::max(newest_ns_, origin_ns);
  for (int i = 0; i < kLandmarks; ++i)
    if (was_seen(seen.points[i])) tracks_[i].update(origin_ns, position_px(seen.points[i]), model_);
}

bool LandmarksAlone::fresh(std::int64_t time_ns) const {
  return time_ns - newest_ns_ <= kFresh_ns &&
         std::ranges::any_of(tracks_, [](const PointTrack& track) { return track.known(); });
}

void LandmarksAlone::forget() {
  newest_ns_ = 0;
  for (PointTrack& track : tracks_) track.forget();
}

}  // namespace handcast::renderer
