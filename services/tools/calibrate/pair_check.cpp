// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/pair_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "services/tools/calibrate/pair_views.hpp"

namespace handcast::calibrate {
namespace {

/// A camera has moved if a board is off by more than this. A pair that was just calibrated is right
/// within 0.8 px and 3 mm. Far away, or with cameras close together, kMovedAlong_mm is less than
/// images tell: there, it must also be kMoved_px.
/// @{
constexpr double kMoved_px = 1.5, kMovedAcross_mm = 3, kMovedAlong_mm = 6;
/// @}
constexpr int kPlainlyMissing = 5;  ///< images; in one or two the board may have been blurred

}  // namespace

Outcome judge_pair(const calib::PairOff& off, double square_mm) {
  const double across_mm = 1e3 * glm::length(off.across_m), along_mm = 1e3 * std::abs(off.along_m);
  const bool is_on_lines = off.off_line_px <= kMoved_px,
             is_as_far = along_mm <= kMovedAlong_mm || std::abs(off.parallax_px) <= kMoved_px;
  Outcome outcome{
      fmt::format("at {:.2f} m what both cameras see is off by {:.1f} mm across and {:.1f} mm "
                  "along the first camera's rays, and by {:.1f} px from epipolar lines",
                  off.depth_m, across_mm, along_mm, off.off_line_px),
      is_on_lines && across_mm <= kMovedAcross_mm && is_as_far};
  if (outcome.is_good) return outcome;
  outcome.findings.push_back(
      "one of the two cameras has moved since they were calibrated: measure the step `pair` "
      "again; if it was the first camera, also `screen`");
  // Epipolar lines do not depend on the size of the board.
  if (is_on_lines)
    outcome.findings.push_back(fmt::format(
        "or the squares of this board are not {:g} mm; name the board of the calibration with "
        "--board",
        square_mm));
  return outcome;
}

Result<Outcome> check_pair(Desk& desk) {
  const auto seen = look_at_pair(desk);
  if (!seen) return tl::make_unexpected(seen.error());
  if (seen->views.empty() && seen->missing >= kPlainlyMissing)
    return Outcome{"the second camera does not see the board where it should by the calibration",
                   false,
                   {"the second camera looks elsewhere, or is covered, dark or out of focus: look "
                    "at it, and measure the step `pair` again if it has moved"}};
  const auto& second = *desk.used.camera2;
  const auto off = calib::pair_off(seen->views, desk.used.camera, second);
  if (!off)
    return fail(Errc::bad_data,
                "the board was never still where both cameras see it; hold it nearer to the middle "
                "of both images");
  return judge_pair(*off, desk.options.board.square_mm);
}

}  // namespace handcast::calibrate
