// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/solve/board/board.hpp"
#include "calib/solve/lens/lens_fit.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// A board that two cameras saw at one time, or while it was still.
struct PairView {
  BoardView first, second;
};

/// A lens that was measured before.
struct KnownLens {
  CameraModel camera;
  LensCovariance covariance{};  ///< all 0: the lens is exact
};
using KnownLenses = std::array<KnownLens, 2>;  ///< of the first and of the second camera

/// One of the given views.
struct FittedPairView {
  double rms_px = 0;     ///< distance of the corners of both images from where the fit has them
  std::string rejected;  ///< why the view was left out, one sentence; empty: it was not
};

/// The result of fit_pair(). Distances are those between two points, not per axis.
struct PairFit {
  glm::dmat4 second_from_first{1};  ///< rigid, in metres
  double rms_px = 0;                ///< over the views that were not rejected
  /// Of views that the fit has not seen: the distance of a corner from the epipolar line of the
  /// same corner in the other image (root mean square, undistorted px); and the distance of the
  /// corners that both cameras give from where the first camera alone has the board, whose size is
  /// known.
  /// @{
  double held_out_px = 0;
  double held_out_mm = 0;
  /// @}
  Spread apart_mm;                 ///< distance between the cameras
  std::array<Spread, 3> place_mm;  ///< the second camera in the axes of the first
  std::array<Spread, 3> turn_deg;  ///< rotation vector of second_from_first
  glm::dvec3 middle_m{0};          ///< of all boards, in the space of the first camera
  double middle_mm = 0;            ///< 95 % of the fits have it within this, in the second's space
  std::vector<FittedPairView> views;  ///< one for each of the given views
};

/// Where the second of two cameras is, from views of a board that both saw. The lenses are kept;
/// the poses of the boards and that of the second camera are fitted together to the corners of both
/// images. Views that contradict the others are left out. The spreads are a bootstrap over the
/// views with drawn errors of both lenses (describe_spread()).
///
/// Errors: bad_data, with a sentence that says what to do: too few views, or views that contradict
/// each other.
Result<PairFit> fit_pair(std::span<const PairView> views, const KnownLenses& lenses);

}  // namespace handcast::calib
