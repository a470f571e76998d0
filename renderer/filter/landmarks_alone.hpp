// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "renderer/filter/filters.hpp"
#include "renderer/filter/point_track.hpp"

namespace handcast::renderer {

/// The landmarks followed by themselves, without the tracker: less exact than with it, but right
/// while it is silent, and a witness when the two disagree.
class LandmarksAlone {
 public:
  explicit LandmarksAlone(const config::Filter& settings);

  void detection(std::int64_t origin_ns, const msg::HandLandmarks& seen);

  bool fresh(std::int64_t time_ns) const;  ///< known, and not from long before
  std::int64_t newest_ns() const { return newest_ns_; }
  bool known(int i) const { return tracks_[i].known(); }
  glm::vec2 at(int i, std::int64_t time_ns) const { return tracks_[i].at(time_ns); }
  void forget();

 private:
  PointTrack::Model model_;
  std::int64_t newest_ns_ = 0;
  std::array<PointTrack, kLandmarks> tracks_{};
};

}  // namespace handcast::renderer
