// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "ipc/base/result.hpp"

namespace handcast::camera::leap {

/// Where the calibration lies in the controller's memory, one byte per address.
inline constexpr int kCalibrationAddress = 100;
inline constexpr std::size_t kCalibrationBytes = 156;  ///< its size

/// One eye as its maker has measured it, in pixels of the image of 640x480.
///
/// The lens is described from the image to the ray: with d the distance of an image point from the
/// centre in focal lengths and s = d^2, the ray's slope is
///
///     d (1 + s (k0 + s (k1 + s k2))) / (1 + s (k3 + s (k4 + s k5)))
///
/// The tangential terms are small and those of OpenCV, p1 and p2, from the ray to the image.
struct EyeCalibration {
  double focal_px = 0;             ///< of rows and columns alike
  glm::dvec2 offset_px{0};         ///< of the optical axis from the middle of the image
  glm::dvec2 tangential{0};        ///< p1, p2
  std::array<double, 6> radial{};  ///< k0 to k5
  glm::dvec3 rotation{0};  ///< to the frame that both eyes share: Cayley's parameters, negated

  /// The slopes x/z, y/z of the ray of an image point whose distances from the centre, in focal
  /// lengths, are `image`; without the tangential terms.
  glm::dvec2 ray_of(const glm::dvec2& image) const;
};

/// The calibration in a controller.
struct ControllerCalibration {
  double baseline_m = 0;  ///< from the left to the right eye
  /// The eyes as the controller itself looks.
  /// @{
  EyeCalibration left, right;
  /// @}
};

/// Reads the block. Its checksum is not verified: how it is computed is not known. Errors: bad_data
/// (another size; a figure that no controller can have, as in a memory that is empty).
Result<ControllerCalibration> parse_calibration(std::span<const std::uint8_t> block);

/// Maps points of the left eye's camera space to the right eye's, in metres.
glm::dmat4 right_from_left(const ControllerCalibration& calibration);

}  // namespace handcast::camera::leap
