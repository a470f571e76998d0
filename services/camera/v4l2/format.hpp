// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "config/sections/sensors.hpp"

namespace handcast::camera::v4l2 {

/// The formats in the order in which `auto` tries them.
inline constexpr std::array kFormats{config::WebcamFormat::grey, config::WebcamFormat::y16,
                                     config::WebcamFormat::y10,  config::WebcamFormat::nv12,
                                     config::WebcamFormat::yuyv, config::WebcamFormat::mjpeg};

/// The kernel's four-character code of a format; 0 for `automatic`.
std::uint32_t code_of(config::WebcamFormat format);
/// The format with this code; empty if handcast cannot read it.
std::optional<config::WebcamFormat> format_of(std::uint32_t code);
/// The code as text, e.g. "YUYV".
std::string text_of(std::uint32_t code);
/// The word of a format in a rig file, e.g. "YUYV".
std::string_view word_of(config::WebcamFormat format);

/// Bytes from one pixel to its right neighbour in the (first) plane; 0 for a compressed format.
std::size_t bytes_per_pixel(config::WebcamFormat format);

/// How the pixels of an image lie in memory.
struct Layout {
  config::WebcamFormat format = config::WebcamFormat::grey;
  int width_px = 0, height_px = 0;
  std::size_t bytes_per_row = 0;  ///< of the (first) plane; 0 for a compressed format
};

}  // namespace handcast::camera::v4l2
