// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "services/calibrate/session.hpp"

/// The report of a calibration: an HTML page and its pieces.
namespace handcast::calibrate {

/// The section of a step.
std::string piece_html(std::string_view step, const Outcome& outcome);
/// The page. `pieces`: sections of the steps.
std::string report_html(const std::string& rig, const calib::Calibration& draft,
                        const std::string& pieces);

/// A point of a picture with an error.
struct Dot {
  glm::dvec2 at_px;
  glm::dvec2 error_px{0};
};
/// A picture (SVG) of an image of this size with dots, and their errors as lines `scale` times as
/// long, with a caption.
std::string dots_svg(int width_px, int height_px, std::span<const Dot> dots, double scale,
                     std::string_view caption);
/// A table with a head; all texts are plain.
std::string table_html(std::span<const std::string> head,
                       std::span<const std::vector<std::string>> rows);

}  // namespace handcast::calibrate
