// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/solve/tracker/fit_tracker.hpp"
#include "calib/solve/tracker/refine.hpp"

namespace handcast::calib {

/// How far the sightings that fit extend.
struct Cover {
  double image_share = 0;  ///< of 60 px squares of the image that hold at least 3 points
  double depth_m = 0;      ///< between the 2nd and the 98th percentile
  double mm_per_px = 0;    ///< at the median depth
};
Cover cover_of(const Observations& observations, const TrackerPose& pose,
               const std::vector<bool>& inliers);

/// A time in which far fewer sightings fit than otherwise, in seconds since the first sighting.
struct MisfitRun {
  double begin_s = 0, end_s = 0;
};
/// The longest one of at least 0.5 s.
std::optional<MisfitRun> misfit_run(const Observations& observations,
                                    const std::vector<bool>& inliers);

/// What was found out about a fit besides its figures.
struct Evidence {
  Cover cover;
  bool is_hand = false;                     ///< the points are landmarks of a hand
  std::vector<MisfitRun> runs;              ///< left out
  std::optional<double> second_pose_rad;    ///< how far another pose is that fits nearly as well
  std::optional<std::string> other_finger;  ///< a sentence
  std::optional<std::string> mirrored;      ///< a sentence
  double plane_m = 0;                       ///< standard deviation across the points' plane
  double limit_shift_mm = 0;                ///< see Uncertainty
  int unusable_sightings = 0, unusable_samples = 0;
};

/// Sightings of one point that fit another point much better, as a sentence. All sightings that
/// were not left out for other reasons should be given.
std::optional<std::string> other_finger(const Observations& observations, const Refined& refined);

/// If points mirrored in the image, or a mirrored hand, fit much better than `cost_px2`: a
/// sentence.
std::optional<std::string> mirrored_fit(const Observations& observations, double cost_px2);

/// Sets the quality and the findings of a fit from its figures and the evidence.
void judge(const Evidence& evidence, TrackerFit& fit);

}  // namespace handcast::calib
