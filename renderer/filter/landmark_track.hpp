// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "config/sections/cascade.hpp"
#include "ipc/msg/landmarks.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/filter/landmark_filter.hpp"
#include "renderer/predict/hand_track.hpp"

namespace handcast::renderer {

/// The landmarks of one hand at the time of the photons (T).
struct Filtered {
  LandmarkPoints landmarks{};           ///< Q̂, or P if nothing corrects it
  bool has_landmarks = false;           ///< `landmarks` are Q̂
  bool has_news = true;                 ///< an input arrived since the last frame, so Q̂ may jump
  std::optional<std::int64_t> seen_ns;  ///< origin of the newest detection behind Q̂
};

/// Step "filter" and its state: the detections of one hand, carried to the time of the photons. See
/// `docs/method.md#filter`. One thread.
class LandmarkTrack {
 public:
  /// Without detections. `oracle`: see make_landmark_filter().
  explicit LandmarkTrack(const config::Filter& settings, LandmarkOracle oracle = {})
      : filter_(make_landmark_filter(settings, std::move(oracle))) {}
  /// Filters with other settings, which are not "ideal", from now on: begins with the next
  /// detection.
  void adjust(const config::Filter& settings) { filter_ = make_landmark_filter(settings, {}); }

  /// Reports the result of HandTrack::push() for a sample that arrived at `now_ns`.
  void tracker_sample(std::int64_t now_ns, PoseHistory::Pushed pushed);
  /// Adds a detection in the image exposed at `origin_ns`, which arrived at `now_ns`. `track`: the
  /// same hand.
  void detection(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const HandTrack& track);

  /// Q̂ for `target_ns`. `predicted`: the hand at that time. Call it once per frame: filters
  /// remember their output.
  Filtered filter(std::int64_t now_ns, std::int64_t target_ns, const Predicted& predicted);

 private:
  std::unique_ptr<LandmarkFilter> filter_;
  bool was_silent_ = false, has_news_ = false;
  std::optional<std::int64_t> seen_ns_;  ///< origin of the newest detection
};

}  // namespace handcast::renderer
