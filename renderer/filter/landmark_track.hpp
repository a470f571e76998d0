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

/// The landmarks of one hand at the time of the photons.
struct Filtered {
  LandmarkPoints landmarks{};  ///< Q̂, or P if nothing corrects it
  bool has_landmarks = false;  ///< landmarks are Q̂
  bool is_alone = false;  ///< the tracker is silent, or was a moment ago: Q̂ goes on without it
  bool has_news = true;   ///< an input arrived since the last frame: Q̂ may jump against it
  std::optional<std::int64_t> seen_ns;  ///< origin of the newest detection behind Q̂
};

/// Step "filter" of the cascade and its state: the detections of one hand, carried to the time of
/// the photons. One thread.
class LandmarkTrack {
 public:
  /// `oracle`: for the filter "ideal", in a simulator.
  explicit LandmarkTrack(const config::Filter& settings, LandmarkOracle oracle = {})
      : filter_(make_landmark_filter(settings, std::move(oracle))) {}

  /// `track` took a sample in at `now_ns`.
  void tracker_sample(std::int64_t now_ns, PoseHistory::Pushed pushed);
  /// A detection in the image of `origin_ns` arrived at `now_ns`.
  void detection(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen,
                 const HandTrack& track);

  /// Q̂ for `target_ns`. Call it once per frame: filters remember their output.
  Filtered filter(std::int64_t now_ns, std::int64_t target_ns, const Predicted& predicted);

  /// Where the landmarks should be seen at `time_ns`: P moved as in the last frame. Empty if the
  /// hand is not in sight.
  std::optional<LandmarkPoints> expected_at(std::int64_t time_ns, const HandTrack& track) const;
  /// Filtered::is_alone of the last frame.
  bool is_alone() const { return is_alone_; }

 private:
  std::unique_ptr<LandmarkFilter> filter_;
  bool is_alone_ = false, was_silent_ = false;
  bool has_news_ = false;
  int seen_again_ = 0;                   ///< detections since the tracker is heard again
  std::optional<std::int64_t> seen_ns_;  ///< origin of the newest detection
  LandmarkPoints moved_px_{};            ///< Q̂ - P of the last frame
};

}  // namespace handcast::renderer
