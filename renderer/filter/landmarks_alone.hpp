// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "renderer/filter/landmark_filter.hpp"
#include "renderer/filter/point_track.hpp"

namespace handcast::renderer {

/// The landmarks of one hand filtered without the tracker, each by a PointTrack. Less exact than
/// with the tracker, but valid while it is silent, and an independent estimate if the two disagree.
class LandmarksAlone {
 public:
  /// Without detections. Uses motion_process and noise_px.
  explicit LandmarksAlone(const config::Filter& settings);

  /// Adds a detection. One more than 80 ms after the last restarts the tracks.
  void detection(std::int64_t origin_ns, const msg::HandLandmarks& seen);

  /// True if a landmark is known and the newest detection is at most 80 ms older than `time_ns`.
  bool fresh(std::int64_t time_ns) const;
  /// Origin of the newest detection; 0 if there is none.
  std::int64_t newest_ns() const { return newest_ns_; }
  /// True if landmark `i` has been seen.
  bool known(int i) const { return tracks_[i].known(); }
  /// Position of landmark `i` at `time_ns`, undistorted camera px; valid if known(i).
  glm::vec2 at(int i, std::int64_t time_ns) const { return tracks_[i].at(time_ns); }
  /// Drops all detections.
  void forget();

 private:
  PointTrack::Model model_;
  std::int64_t newest_ns_ = 0;
  std::array<PointTrack, kLandmarks> tracks_{};
};

}  // namespace handcast::renderer
