// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "calib/solve/latency/light_delay.hpp"

namespace handcast::calib {

/// The voltage of a photodiode that a sound card has sampled without a gap.
struct SoundClip {
  std::vector<float> samples;  ///< -1..1 of full scale
  double first_ns = 0;         ///< time of the first one, CLOCK_MONOTONIC
  double period_ns = 0;        ///< from one sample to the next
  std::int64_t error_ns = 0;   ///< how far these times may be off
};

/// Finds the delay at which a light that toggles explains a clip. An edge is where the mean of the
/// next 3 ms differs most from that of the last 3 ms, in the direction of its toggle: inputs of
/// sound cards pass no constant voltage, and may be inverted. The delay is the median over the
/// toggles, with a 95 % interval by 400 resamples of them, widened by error_ns. contrast: the size
/// of the steps, percent of full scale. Toggles must be in order of time. Errors: bad_data (fewer
/// than 6 sure toggles in the clip; no edges that stand out from the noise; their times scatter by
/// more than 5 ms).
Result<LightDelay> fit_sound_delay(std::span<const Toggle> toggles, const SoundClip& clip);

}  // namespace handcast::calib
