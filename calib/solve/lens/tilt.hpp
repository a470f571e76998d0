// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "calib/solve/board/board.hpp"

namespace handcast::calib {

/// How the board is tilted against the image, without a calibration: by how much its distance grows
/// to the right and downwards in the image, about the tangent of the angle. `scale_px`: a guess of
/// the focal length. Nothing if the points do not determine it.
std::optional<glm::dvec2> tilt_of(const BoardView& view, double scale_px);

/// A focal length for tilt_of(), when nothing is known of the lens.
inline double usual_focal_length_px(int width_px) { return 1.3 * width_px; }

/// The largest distance of a corner from where the homography that fits the board best has it, as a
/// share of the distance between neighbours; infinite if there is no homography.
double mistake_of(const BoardView& view);

}  // namespace handcast::calib
