// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>

#include "calib/screen/depth_error.hpp"
#include "services/calibrate/session.hpp"

/// The report of a calibration: an HTML page and its pieces.
namespace handcast::calibrate {

/// The section of a step.
std::string piece_html(std::string_view step, const Outcome& outcome);
/// The page. `steps`: those that the rig has need of. `pieces`: sections of the steps.
std::string report_html(const std::string& rig, std::span<const Step> steps,
                        const calib::Calibration& draft, const std::string& pieces);

/// Pictures (SVG) of the camera's image, one for each depth, darker where the error is larger, and
/// a caption. Below each are its depth and its largest error.
std::string errors_svg(const calib::ErrorVolume& errors, std::string_view caption);

/// A picture (SVG) of an image of this size with dots, and a caption.
std::string dots_svg(int width_px, int height_px, std::span<const glm::dvec2> dots_px,
                     std::string_view caption);

}  // namespace handcast::calibrate
