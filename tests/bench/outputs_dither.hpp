// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "renderer/output/dither.hpp"

namespace handcast::bench {

/// The noise of dithered areas of one grey, RMS as shares of full light, as the mean over greys
/// from 2 % to 95 % of the light. The eye is a Gaussian of 1.5 px.
struct DitherNoise {
  double plane = 0;       ///< one plane, seen for a moment
  double followed = 0;    ///< an output frame whose pattern the eye passes at 0 to 3 px per plane
  double worst = 0;       ///< the same, the worst speed and grey
  double frame = 0;       ///< the mean of the planes of an output frame, in which the eye rests
  double flicker = 0;     ///< changes at once and twice the output's rate
  double mean_error = 0;  ///< of the light of the area; the largest one of all greys
};

/// `moves`: as in Packer; otherwise all planes have the thresholds of plane 0.
DitherNoise noise_of(const renderer::Dither& dither, bool moves);

/// Other patterns, for comparison: ordered dither (Bayer 1973, "An optimum method for two-level
/// rendition of continuous-tone pictures"), and random numbers.
/// @{
renderer::Image<std::uint16_t> bayer_pattern();
renderer::Image<std::uint16_t> white_noise();
/// @}

}  // namespace handcast::bench
