// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/image.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"

namespace handcast::landmarks {

/// The landmarks of one hand as a model sees them in one region.
struct LandmarkEstimate {
  Points points_px{};                             ///< in the image
  std::array<float, msg::kLandmarks> sigma_px{};  ///< standard deviation per axis; 0: not known
  float presence = 0;                             ///< 0..1: how likely there is a hand
  /// 0..1: how likely it is a left hand, in an image that is not mirrored. 0.5 if the model does
  /// not score sides.
  float left_score = 0.5f;
};

/// How long the parts of an estimate took.
struct EstimateTimes {
  std::int64_t crop_ns = 0;     ///< resampling of the region and encoding of the input
  std::int64_t network_ns = 0;  ///< the network itself
};

/// Estimates the landmarks of one hand in a region of an image: a neural network with its crop. One
/// thread.
class LandmarkModel {
 public:
  virtual ~LandmarkModel() = default;

  /// How a model differs from others for those who use it.
  struct Traits {
    /// How often a hand is estimated that was not in the last image. Each time but the first, the
    /// region is the one around the last estimate.
    int passes_at_first = 1;
    /// Whether left_score is set. A model that does not set it is told the side, and has the
    /// smaller sigma if that is right.
    bool scores_sides = false;
    /// Whether the tracker's joints are an input of the network.
    bool reads_tracker = false;
    /// Whether its points are the tracker's joints. Those of other models may be defined a few
    /// pixels beside them.
    bool finds_tracker_joints = false;
  };
  /// Those of this model; they never change.
  virtual Traits traits() const = 0;

  /// The region for a hand that was at these points a moment ago, or that the tracker has there.
  virtual Region region_around(const Points& points_px) const = 0;

  /// Estimates the landmarks of the hand in `region`. `side`: which hand it is taken for.
  /// `tracker_px`: the tracker's joints in the image; nothing if the tracker does not see the hand.
  /// Adds to `times`. Errors: bad_data.
  virtual Result<LandmarkEstimate> estimate(renderer::GreyView image, const Region& region,
                                            msg::Side side, const std::optional<Points>& tracker_px,
                                            EstimateTimes& times) = 0;
};

}  // namespace handcast::landmarks
