// SPDX-License-Identifier: Apache-2.0
#include "services/tools/detect/picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/media/picture.hpp"
#include "services/joints/leap_hand.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::detect {

Result<renderer::Image<std::uint8_t>> read_grey(const std::filesystem::path& file) {
  const auto colour = renderer::read_picture(file);
  if (!colour) return tl::make_unexpected(colour.error());
  renderer::Image<std::uint8_t> grey(colour->width(), colour->height());
  for (std::size_t i = 0; i < grey.pixels().size(); ++i) {
    const std::uint32_t rgba = colour->pixels()[i];
    const std::uint32_t red = rgba & 255, green = rgba >> 8 & 255, blue = rgba >> 16 & 255;
    grey.pixels()[i] = static_cast<std::uint8_t>((299 * red + 587 * green + 114 * blue + 500) /
                                                 1000);  // ITU-R BT.601
  }
  return grey;
}

Result<landmarks::Points> read_joints(const std::filesystem::path& file, int width_px,
                                      int height_px) {
  const auto array = recording::read_npy(file);
  if (!array) return tl::make_unexpected(array.error());
  const bool in_px = array->shape == std::vector<std::size_t>{msg::kLandmarks, 2};
  if (!in_px && array->shape != std::vector<std::size_t>{joints::kLeapJoints, 2})
    return fail(Errc::bad_config,
                fmt::format("'{}' has the shape ({}); expected (21, 2) or (42, 2)", file.string(),
                            fmt::join(array->shape, ", ")));
  landmarks::Points points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t at =
        in_px ? i : static_cast<std::size_t>(joints::kLeapJoint[msg::kJointOfLandmark[i]]);
    const glm::dvec2 point(array->values[2 * at], array->values[2 * at + 1]);
    points[i] =
        in_px ? point
              : glm::dvec2((point.x + 1) * 0.5 * width_px, (1 - point.y) * 0.5 * height_px) - 0.5;
  }
  return points;
}

}  // namespace handcast::detect
