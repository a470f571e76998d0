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

  /// The properties in which models differ for their users.
  struct Traits {
    /// Number of estimates of a hand that was not in the last image. From the second on, the region
    /// is that around the previous estimate.
    int passes_at_first = 1;
    /// left_score is set. A model that does not set it needs the side as an input; its sigmas are
    /// smaller if the side is right.
    bool scores_sides = false;
    /// The tracker's joints are an input of the network.
    bool reads_tracker = false;
    /// Of a model that reports no sigmas: the standard deviation of its landmarks per axis, as a
    /// share of the region's side. It says nothing of single landmarks, and so does not change
    /// their confidence. Landmarks have it where HandFinder::Poses::of_a_tracker: poses that are
    /// made from landmarks become worse by it. Only of a model that scores sides: without scores,
    /// sigmas tell them.
    float usual_sigma = 0;
  };
  /// The traits of this model; they never change.
  virtual Traits traits() const = 0;

  /// The region for a hand with these points: those of the last image, or the tracker's joints.
  virtual Region region_around(const Points& points_px) const = 0;

  /// Estimates the landmarks of the hand in `region`. `side`: the assumed side. `tracker_px`: the
  /// tracker's joints in the image; empty if the tracker does not see the hand.
  /// Adds to `times`. Errors: bad_data.
  virtual Result<LandmarkEstimate> estimate(renderer::GreyView image, const Region& region,
                                            msg::Side side, const std::optional<Points>& tracker_px,
                                            EstimateTimes& times) = 0;
};

}  // namespace handcast::landmarks
