// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

namespace handcast::renderer {

/// The light 0..1 of a level 0..1 in sRGB (IEC 61966-2-1), and its inverse.
/// @{
inline double srgb_light(double level) {
  return level <= 0.04045 ? level / 12.92 : std::pow((level + 0.055) / 1.055, 2.4);
}
inline double srgb_level(double light) {
  return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}
/// @}

/// srgb_level() to 0.003 (to 0.04 for a light below 0.005), by operations that a loop can do on
/// vectors.
inline float fast_srgb_level(float light) {
  const float root = std::sqrt(light), fourth = std::sqrt(root), eighth = std::sqrt(fourth);
  return 0.5851f * root + 0.7831f * fourth - 0.3682f * eighth;
}

}  // namespace handcast::renderer
