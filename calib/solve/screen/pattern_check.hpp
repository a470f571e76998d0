// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/solve/board/grey_view.hpp"

namespace handcast::calib {

/// How far the images of a pattern and of its inverse are from adding up to those of white and
/// black, as a share of white minus black: the 70th percentile over the brighter half of the lit
/// pixels. Noise and the edges of a print in a trembling hand give 0.05 to 0.3, most if the light
/// is weak; an image of another pattern, taken too early or too late, about 1; a light that
/// flickers what it flickers; a board that moves 1 to 3. 0 if nothing is lit. All images must have
/// the same size.
double pattern_misfit(const GreyView& white, const GreyView& black, const GreyView& pattern,
                      const GreyView& inverse);

/// The misfit above which a pattern should be shown again.
inline constexpr double kMostPatternMisfit = 0.6;

}  // namespace handcast::calib
