// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "renderer/filter/landmark_filter.hpp"

/// @file
/// The filters behind make_landmark_filter(), one file each, and what they share.

namespace handcast::renderer {

/// A filter that can be reset.
class CarryFilter : public LandmarkFilter {
 public:
  void tracker_sample(std::int64_t) override {}
  /// Drops what was learned from detections. What is remembered of the tracker is kept.
  virtual void forget() = 0;
};

/// Q̂ = Q: the landmarks as they were seen.
std::unique_ptr<CarryFilter> make_naive_filter();
/// The newest offset Q - P of each point, added to P (paper, "Moving Least Squares Deformation").
std::unique_ptr<CarryFilter> make_paper_filter();
/// A constant-velocity Kalman filter on Q, without the tracker.
std::unique_ptr<CarryFilter> make_kalman_filter(const config::Filter& settings);

/// Wraps `inner`: its correction fades out within 100 ms once the newest detection is older than
/// lost_ms, and the jumps of its output are smoothed (JumpBlend).
std::unique_ptr<LandmarkFilter> make_settled_filter(const config::Filter& settings,
                                                    std::unique_ptr<CarryFilter> inner);

/// P plus the offsets, the unknown ones being the mean of the known. Empty if no offset is known.
std::optional<LandmarkPoints> moved_by(const LandmarkPoints& tracker,
                                       std::array<glm::vec2, kLandmarks> offsets,
                                       const std::array<bool, kLandmarks>& known);

}  // namespace handcast::renderer
