// SPDX-License-Identifier: Apache-2.0
#include "calib/drift/correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "calib/rigid.hpp"

namespace handcast::calib {

Result<glm::dmat4> corrected(const Calibration& calibration, const Drift& drift) {
  constexpr double kMostDepth_m = 0.003;
  if (!drift.moved)
    return fail(
        Errc::bad_data,
        fmt::format("the tracker has not moved beyond doubt: {:.1f} mm +- {:.1f} and {:.2f} "
                    "degrees +- {:.2f}, by {} places of still hands",
                    drift.across_mm, 2 * drift.across_sd_mm, drift.turn_deg, 2 * drift.turn_sd_deg,
                    drift.places));
  if (!(drift.across_mm <= kMostCorrection_mm && drift.turn_deg <= kMostCorrection_deg))
    return fail(Errc::bad_data,
                fmt::format("the tracker has moved by {:.0f} mm and {:.1f} degrees, which is too "
                            "far for a correction; measure its place anew: handcast calibrate "
                            "RIG.toml tracker",
                            drift.across_mm, drift.turn_deg));
  auto shift_m = drift.shift_m;
  shift_m.z = std::clamp(shift_m.z, -kMostDepth_m, kMostDepth_m);
  const double angle = glm::length(drift.turn_rad);
  auto motion = glm::translate(glm::dmat4(1), drift.pivot_m + shift_m);
  if (angle > 0) motion = glm::rotate(motion, angle, drift.turn_rad / angle);
  motion = glm::translate(motion, -drift.pivot_m);
  return orthonormalised(motion * calibration.camera_from_tracker);
}

}  // namespace handcast::calib
