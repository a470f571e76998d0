// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <optional>
#include <string_view>

#include "calib/solve/board/grey_view.hpp"

namespace handcast::calib {

/// Why an image does not show where the reflector is.
enum class ReflectorFault {
  none,     ///< it does
  dark,     ///< nothing is bright enough
  several,  ///< several small bright spots
  merged,   ///< what is bright is large or not round: skin is as bright as the reflector
};

/// A retro-reflector in one image.
struct Reflector {
  ReflectorFault fault = ReflectorFault::dark;
  glm::dvec2 image_px{0};  ///< its centre, lens distortion included; only without a fault
  double diameter_px = 0;  ///< of a circle with its area
};

/// Finds the one small, round spot that is far brighter than all else: pixels above four fifths of
/// the brightest grey value, joined to spots; its centre is the mean of the pixels, weighted by
/// their height above the level beside it. Noise of a few grey values moves it by less than
/// 0.15 px. Spots of fewer than 6 pixels are noise.
Reflector find_reflector(const GreyView& image);

/// What a person should do about a fault; "" without one.
std::string_view advice_on(ReflectorFault fault);

}  // namespace handcast::calib
