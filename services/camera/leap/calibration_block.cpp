// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/calibration_block.hpp"

#include <fmt/format.h>

#include <string_view>

#include "services/camera/leap/little_endian.hpp"

namespace handcast::camera::leap {
namespace {

/// Two bytes of signature, version, score, a date; then floats.
constexpr std::size_t kBaseline = 8, kLeft = 16, kEye = 17 * 4, kRight = kLeft + kEye;

/// The floats of an eye in their order.
enum EyeFloat { kFocal, kOffset, kTangential = 3, kRadial = 5, kRotation = 14 };

Result<double> figure(std::span<const std::uint8_t> block, std::size_t at, double least,
                      double most, std::string_view what) {
  const double value = get_float(block, at);
  if (value >= least && value <= most) return value;  // false for NaN
  return fail(Errc::bad_data,
              fmt::format("{} is {}; it should be {} to {}", what, value, least, most));
}

/// The floats of an eye that are used, with what they can be.
struct EyeFigure {
  int at;
  std::string_view what;
  double least, most;
};
constexpr EyeFigure kEyeFigures[] = {
    {kFocal, "focal length", 40, 1000},
    {kOffset, "horizontal offset", -100, 100},
    {kOffset + 1, "vertical offset", -100, 100},
    {kTangential, "first tangential term", -0.5, 0.5},
    {kTangential + 1, "second tangential term", -0.5, 0.5},
    {kRadial, "first radial term", -100, 100},
    {kRadial + 1, "second radial term", -100, 100},
    {kRadial + 2, "third radial term", -100, 100},
    {kRadial + 3, "fourth radial term", -100, 100},
    {kRadial + 4, "fifth radial term", -100, 100},
    {kRadial + 5, "sixth radial term", -100, 100},
    {kRotation, "first rotation", -0.5, 0.5},
    {kRotation + 1, "second rotation", -0.5, 0.5},
    {kRotation + 2, "third rotation", -0.5, 0.5},
};

Result<EyeCalibration> parse_eye(std::span<const std::uint8_t> block, std::size_t begin) {
  std::array<double, 17> floats{};
  for (const auto& [at, what, least, most] : kEyeFigures) {
    const auto place = static_cast<std::size_t>(at);
    const auto value = figure(block, begin + 4 * place, least, most, what);
    if (!value) return tl::make_unexpected(value.error());
    floats[place] = *value;
  }
  EyeCalibration eye;
  eye.focal_px = floats[kFocal];
  eye.offset_px = {floats[kOffset], floats[kOffset + 1]};
  eye.tangential = {floats[kTangential], floats[kTangential + 1]};
  for (std::size_t i = 0; i < eye.radial.size(); ++i) eye.radial[i] = floats[kRadial + i];
  eye.rotation = {floats[kRotation], floats[kRotation + 1], floats[kRotation + 2]};
  return eye;
}

/// Cayley's transform: (1 - |p|^2 + 2 p p^T + 2 [p]x) / (1 + |p|^2).
glm::dmat3 rotation_of(const glm::dvec3& p) {
  const double square = glm::dot(p, p);
  const glm::dmat3 cross(0, p.z, -p.y, -p.z, 0, p.x, p.y, -p.x, 0);
  return (glm::dmat3(1 - square) + 2. * glm::outerProduct(p, p) + 2. * cross) / (1 + square);
}

}  // namespace

glm::dvec2 EyeCalibration::ray_of(const glm::dvec2& image) const {
  const double s = glm::dot(image, image);
  const auto& k = radial;
  return image *
         ((1 + s * (k[0] + s * (k[1] + s * k[2]))) / (1 + s * (k[3] + s * (k[4] + s * k[5]))));
}

Result<ControllerCalibration> parse_calibration(std::span<const std::uint8_t> block) {
  if (block.size() != kCalibrationBytes)
    return fail(Errc::bad_data,
                fmt::format("a calibration has {} bytes, not {}", kCalibrationBytes, block.size()));
  const auto baseline_mm = figure(block, kBaseline, 5, 200, "distance of the eyes in mm");
  if (!baseline_mm) return tl::make_unexpected(baseline_mm.error());
  const auto left = parse_eye(block, kLeft), right = parse_eye(block, kRight);
  if (!left) return fail_in("left eye", left.error());
  if (!right) return fail_in("right eye", right.error());
  return ControllerCalibration{*baseline_mm * 1e-3, *left, *right};
}

glm::dmat4 right_from_left(const ControllerCalibration& calibration) {
  const auto shared_from_left = rotation_of(-calibration.left.rotation);
  const auto right_from_shared = glm::transpose(rotation_of(-calibration.right.rotation));
  glm::dmat4 pose(right_from_shared * shared_from_left);
  pose[3] = glm::dvec4(right_from_shared * glm::dvec3(-calibration.baseline_m, 0, 0), 1);
  return pose;
}

}  // namespace handcast::camera::leap
