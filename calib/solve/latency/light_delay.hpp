// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "ipc/base/result.hpp"

namespace handcast::calib {

/// A change of the projector's light between dark and bright. Times are CLOCK_MONOTONIC.
struct Toggle {
  std::int64_t begin_ns = 0;  ///< when the light changes, as the projector reports it
  bool is_bright = false;     ///< afterwards
  bool is_sure = true;        ///< false: begin_ns may be late, and is not fitted
};

/// How bright the projector's light was in one camera image.
struct Brightness {
  std::int64_t origin_ns = 0;    ///< middle of the exposure
  std::int64_t exposure_ns = 0;  ///< its duration
  double grey = 0;               ///< mean grey value
  std::int64_t error_ns = 0;     ///< how far origin_ns may be off; 0: not known
};

/// The delay of the light: how much later it changes than the projector reports.
struct LightDelay {
  double delay_ms = 0;
  double low_ms = 0, high_ms = 0;  ///< 95 % interval
  /// How much of the interval is due to the gaps between exposures, in which nothing is seen. It is
  /// large if camera and projector keep step: then all changes fall into the same gap.
  double unseen_ms = 0;
  double contrast = 0;  ///< bright less dark, grey values
};

/// The longest delay that is looked for, in both directions.
inline constexpr double kLongestDelay_ms = 250;

/// Finds the delay at which a light that toggles explains the images: the share of each exposure in
/// which the light was bright is compared with its grey value, on a line of its own for each
/// toggle, for delays in steps of 0.1 ms (least squares). The interval is that of 400 resamples of
/// the toggles (Efron & Tibshirani 1993, percentiles), widened to all delays that explain the
/// images equally well, and by the median error of the images' times. Toggles must be in order of
/// time and more than two images apart, the images in order of time. Errors: bad_data (the camera
/// does not see the light), unavailable (fewer than 6 toggles with images), bad_config (the delay
/// is longer than kLongestDelay_ms).
Result<LightDelay> fit_light_delay(std::span<const Toggle> toggles,
                                   std::span<const Brightness> images);

}  // namespace handcast::calib
