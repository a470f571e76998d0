// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>

#include "calib/solve/screen/depth_error.hpp"

/// The pictures (SVG) of the report of a calibration.
namespace handcast::calibrate {

/// The camera's image, one for each depth, darker where the error is larger, and a caption. Below
/// each are its depth and its largest error.
std::string errors_svg(const calib::ErrorVolume& errors, std::string_view caption);

/// An image of this size with dots, and a caption, to which the size is added. Of very many dots,
/// some are left out.
std::string dots_svg(int width_px, int height_px, std::span<const glm::dvec2> dots_px,
                     std::string_view caption);

/// What one image or view is off by.
struct Bar {
  double value = 0;
  bool is_left_out = false;  ///< it took no part in the fit
};
/// Bars side by side, numbered from 1, with their largest value; those that were left out have
/// another colour.
std::string bars_svg(std::span<const Bar> bars, std::string_view unit, std::string_view caption);

}  // namespace handcast::calibrate
