// SPDX-License-Identifier: Apache-2.0
#include "services/tools/detect/picture.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/media/picture.hpp"
#include "services/joints/leap_hand.hpp"
#include "services/recording/arrays/recorded_hands.hpp"

namespace handcast::detect {

Result<renderer::Image<std::uint8_t>> read_grey(const std::filesystem::path& file) {
  auto picture = renderer::read_camera_picture(file);
  if (picture && renderer::used_bits_of(picture->largest) < 16)
    picture = renderer::read_camera_picture(file, renderer::used_bits_of(picture->largest));
  if (!picture) return tl::make_unexpected(picture.error());
  return std::move(picture->grey);
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
