// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/tracker/sightings.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// What a fit is good for, by the error of the light in the middle of the volume (95 %) and the share
/// of the points that fit.
enum class Quality {
  good,    ///< at most 2 mm, and 70 % of the points
  usable,  ///< at most 5 mm, and 50 %
  poor,    ///< all others
};
constexpr std::array<std::string_view, 3> words_of(Quality) { return {"good", "usable", "poor"}; }

/// Half the width of the 95 % intervals of the parameters of a TrackerFit.
struct TrackerSpread {
  glm::dvec3 turn_deg{0};  ///< about the axes of the camera, through TrackerFit::middle_m
  glm::dvec3 place_mm{0};  ///< of the volume's middle: x, y, z of the camera
  double offset_ms = 0;
};

/// The result of fit_tracker().
struct TrackerFit {
  glm::dmat4 camera_from_tracker{1};  ///< rigid, metres
  /// What the tracker's clock shows at a moment, less what the camera's clock shows.
  std::int64_t clock_offset_ns = 0;
  double inlier_share = 0;  ///< of the sightings at times that the tracker knows: within 3 sigma
  double residual_px = 0;   ///< median distance of those that fit
  double held_out_px = 0;   ///< the same for blocks of time that the fit has not seen
  TrackerSpread spread;
  glm::dvec3 middle_m{0};  ///< of the points that were seen, in tracker space
  /// Half the width of the 95 % interval of the light across the camera's axis, in the middle of the
  /// volume and at the worst of its corners.
  /// @{
  double middle_error_mm = 0, corner_error_mm = 0;
  /// @}
  Quality quality = Quality::poor;
  std::vector<std::string> findings;  ///< what limits it, as sentences, the worst first
};

/// Finds where the tracker is and how far its clock is off, from points that both have seen. The first
/// pose is found among wrong points by random samples (first_pose()); it is refined together with the
/// offset by robust least squares (refine()). A beginning that does not fit is left out. The intervals
/// are those of a jackknife over blocks of a second or more, because errors of neighbouring times are
/// alike (Efron & Stein 1981; one Gauss-Newton step for each block), with Student's t.
///
/// Errors: bad_data (too few sightings, no time at which both have seen something, nothing that
/// fits).
Result<TrackerFit> fit_tracker(std::span<const TrackerSample> samples,
                               std::span<const Sighting> sightings, const CameraModel& camera);

}  // namespace handcast::calib
