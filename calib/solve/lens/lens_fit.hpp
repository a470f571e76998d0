// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/solve/board/board.hpp"
#include "ipc/base/result.hpp"

namespace handcast::calib {

/// Which distortion coefficients a fit has, each with those of the ones before it; the others are
/// 0.
enum class Distortion { none, k1, k2, tangential, k3 };
constexpr std::array<std::string_view, 5> words_of(Distortion) {
  return {"none", "k1", "k1 k2", "k1 k2 p1 p2", "k1 k2 p1 p2 k3"};
}

/// The parameters of a CameraModel that are estimated, in this order.
constexpr std::array<std::string_view, 9> kLensParameters{"fx", "fy", "cx", "cy", "k1",
                                                          "k2", "p1", "p2", "k3"};

/// How well a parameter is known.
struct Spread {
  double deviation = 0;      ///< standard deviation
  double low = 0, high = 0;  ///< the 95 % interval
};

/// The covariance of kLensParameters; 0 for those that were not fitted.
using LensCovariance = std::array<std::array<double, 9>, 9>;

/// One of the given views. If it was rejected and has no pose at all, the error is 0.
struct FittedView {
  double rms_px = 0;                ///< distance of the corners from where the fit has them
  glm::dmat4 camera_from_board{1};  ///< rigid, in metres
  std::string rejected;             ///< why the view was left out, one sentence; empty: it was not
};

/// The result of fit_lens(). Distances are those between two points, not per axis.
struct LensFit {
  CameraModel camera;
  Distortion distortion = Distortion::none;
  double rms_px = 0;                       ///< over the views that were not rejected
  double held_out_px = 0;                  ///< the same for views that the fit has not seen
  std::array<double, 5> held_out_of_px{};  ///< held_out_px of each Distortion
  std::array<Spread, 9> spreads;           ///< of kLensParameters; those not fitted have 0, 0, 0
  LensCovariance covariance{};             ///< of the same bootstrap as the spreads
  std::vector<FittedView> views;           ///< one for each of the given views
};

/// The lens of a camera from views of a board. The fit has the minimum of OpenCV's
/// calibrateCamera (Zhang, "A Flexible New Technique for Camera Calibration"). Views that
/// contradict the others are left out. Of the models of distortion, it takes the simplest that
/// predicts views not seen by the fit (5 parts, each predicted from the others) as well as the best
/// one does. The spreads are a bootstrap over the views, see spread.hpp.
///
/// Errors: bad_data, with a sentence that says what to do: too few views, views that contradict
/// each other, a focal length that cannot be told from the distance since the board was not tilted,
/// a board that was only in the middle of the image.
Result<LensFit> fit_lens(std::span<const BoardView> views, int width_px, int height_px);

}  // namespace handcast::calib
