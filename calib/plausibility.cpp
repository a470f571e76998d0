// SPDX-License-Identifier: Apache-2.0
#include "calib/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "calib/rigid.hpp"

namespace handcast::calib {
namespace {

constexpr double kRigidTolerance = 1e-3;
constexpr double kFarthestTracker_m = 10;
/// The largest area of an image: buffers of up to 46 bytes per pixel of the projector (measured at
/// 8192 x 8192) stay below a gigabyte.
constexpr double kMostArea_px2 = 16e6;

/// Where the pixels of the projector lie in the undistorted camera image, on a grid. Empty if one
/// of them lies nowhere, that is on or behind the horizon of the homography.
std::vector<glm::dvec2> screen_in_camera(const Calibration& calibration) {
  constexpr int kSteps = 16;
  const glm::dmat3 camera_from_projector = glm::inverse(calibration.projector.from_camera);
  const glm::dvec2 last(calibration.projector.width_px - 1, calibration.projector.height_px - 1);
  std::vector<glm::dvec2> grid;
  double side = 0;  // of the horizon, at the first point
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const auto at =
          camera_from_projector * glm::dvec3(last * glm::dvec2(j, i) / double{kSteps}, 1);
      if (grid.empty()) side = at.z;
      const glm::dvec2 px = glm::dvec2(at) / at.z;
      if (!(at.z * side > 0) || !std::isfinite(px.x) || !std::isfinite(px.y)) return {};
      grid.push_back(px);
    }
  return grid;
}

/// Why no coaxial rig can have this homography. Empty if one can.
std::string fault_of_homography(const Calibration& calibration) {
  constexpr double kLeastShare = 0.01;
  const auto grid = screen_in_camera(calibration);
  if (grid.empty()) return "the horizon of the homography crosses the projector's image";
  const glm::dvec2 size(calibration.camera.width_px, calibration.camera.height_px);
  int inside = 0;
  for (const glm::dvec2& px : grid) {
    const glm::dvec2 place = px / size;  // 0..1 in the image
    if (!(glm::all(glm::greaterThan(place, glm::dvec2(-1.5))) &&
          glm::all(glm::lessThan(place, glm::dvec2(2.5)))))
      return fmt::format(
          "the homography puts projector pixels far outside the camera image, e.g. "
          "at ({:.4g}, {:.4g})",
          px.x, px.y);
    inside += glm::all(glm::greaterThan(place, glm::dvec2(0))) &&
              glm::all(glm::lessThan(place, glm::dvec2(1)));
  }
  if (inside < kLeastShare * static_cast<double>(grid.size()))
    return "the homography puts the projector's image beside the camera image";
  const auto [low_x, high_x] = std::minmax_element(
      grid.begin(), grid.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const auto [low_y, high_y] = std::minmax_element(
      grid.begin(), grid.end(), [](const auto& a, const auto& b) { return a.y < b.y; });
  if ((high_x->x - low_x->x) * (high_y->y - low_y->y) < kLeastShare * size.x * size.y)
    return "the homography shrinks the projector's image to a spot";
  return {};
}

/// A projector lights what is a little nearer or farther than the plane of the homography, too.
void check_parallax(const Calibration& calibration, std::string_view file, config::Faults& faults) {
  for (const double share : {0.85, 1.15}) {
    auto other = calibration;
    other.projector.from_camera =
        calibration.projector.homography_at(share * calibration.projector.plane_m);
    const bool is_regular = std::abs(glm::determinant(other.projector.from_camera)) > 1e-9;
    if (is_regular && fault_of_homography(other).empty()) continue;
    faults.add(
        fmt::format("{}: projector.parallax: at {:.2f} m, where the plane of the homography "
                    "is at {:.2f} m, the light would miss the camera's image. Is it in "
                    "pixels times metres?",
                    file, share * calibration.projector.plane_m, calibration.projector.plane_m));
    return;
  }
}

void check_size(std::string_view what, double width_px, double height_px, std::string_view file,
                config::Faults& faults) {
  if (width_px * height_px > kMostArea_px2)
    faults.add(fmt::format("{}: {}: {} x {} px are too many; at most {} megapixels are possible",
                           file, what, width_px, height_px, kMostArea_px2 / 1e6));
}

/// A focal length in pixels of rows or columns against the image's size in that direction: sensors
/// that put rows together have two focal lengths.
void check_focal(std::string_view what, double focal_px, int size_px, std::string_view size,
                 std::string_view file, config::Faults& faults) {
  constexpr double kShortest = 0.15, kLongest = 20;
  if (focal_px < kShortest * size_px || focal_px > kLongest * size_px)
    faults.add(
        fmt::format("{}: {}.focal_px: {} px is not plausible for an image of {} px; it "
                    "must be {} to {} {} of the image",
                    file, what, focal_px, size_px, kShortest, kLongest, size));
}

/// Lenses between a fisheye and a telescope, whose axis meets the image or passes close by.
void check_lens(std::string_view what, const CameraModel& camera, std::string_view file,
                config::Faults& faults) {
  check_focal(what, camera.fx_px, camera.width_px, "widths", file, faults);
  check_focal(what, camera.fy_px, camera.height_px, "heights", file, faults);
  const glm::dvec2 centre(camera.cx_px / camera.width_px, camera.cy_px / camera.height_px);
  if (glm::any(glm::greaterThan(glm::abs(centre - 0.5), glm::dvec2(1.5))))
    faults.add(
        fmt::format("{}: {}.centre_px: the principal point lies more than an image "
                    "beside the image",
                    file, what));
}

/// `what`: "camera_from_tracker"; `whose`: "tracker".
void check_transform(std::string_view what, std::string_view whose, const glm::dmat4& transform,
                     std::string_view file, config::Faults& faults) {
  if (const double off = distance_from_rigid(transform); !(off < kRigidTolerance))
    faults.add(
        fmt::format("{}: {}: its first three columns are not a right-handed "
                    "rotation (off by {:.2g}; {} is allowed)",
                    file, what, off, kRigidTolerance));
  if (const double away_m = glm::length(glm::dvec3(transform[3])); !(away_m < kFarthestTracker_m))
    faults.add(
        fmt::format("{}: {}: the {} is {:.3g} m away from the camera; "
                    "at most {} m are possible. Is it in millimetres?",
                    file, what, whose, away_m, kFarthestTracker_m));
}

void check_camera(std::string_view what, const CameraModel& camera, std::string_view file,
                  config::Faults& faults) {
  check_size(what, camera.width_px, camera.height_px, file, faults);
  check_lens(what, camera, file, faults);
  if (faults.empty() && camera.folds())
    faults.add(
        fmt::format("{}: {}.distortion: the lens folds the image: near its edge, two "
                    "directions map to one pixel",
                    file, what));
}

/// True if the second camera sees a part of what the first one sees within some metres.
bool see_the_same(const CameraModel& first, const SecondCamera& second) {
  constexpr int kSteps = 8;
  for (const double depth_m : {0.15, 0.25, 0.4, 0.6, 0.9, 1.4, 2.0, 3.0, 5.0})
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; j <= kSteps; ++j) {
        const glm::dvec2 px(j * (first.width_px - 1) / kSteps, i * (first.height_px - 1) / kSteps);
        const glm::dvec3 m((px.x - first.cx_px) / first.fx_px * depth_m,
                           (px.y - first.cy_px) / first.fy_px * depth_m, depth_m);
        const glm::dvec3 there(second.from_camera * glm::dvec4(m, 1));
        if (!(there.z > 0)) continue;
        const auto seen = second.camera.project(there);
        if (seen.x >= 0 && seen.y >= 0 && seen.x < second.camera.width_px &&
            seen.y < second.camera.height_px)
          return true;
      }
  return false;
}

/// Two cameras at one place see no depth, and those that see nothing in common see no hand.
void check_pair(const Calibration& calibration, std::string_view file, config::Faults& faults) {
  constexpr double kLeastApart_m = 0.005;
  const auto& second = *calibration.camera2;
  check_transform("camera2_from_camera", "second camera", second.from_camera, file, faults);
  check_camera("camera2", second.camera, file, faults);
  if (glm::length(glm::dvec3(second.from_camera[3])) < kLeastApart_m)
    faults.add(
        fmt::format("{}: camera2_from_camera: the cameras are less than {} mm apart, and see no "
                    "depth. Is it in metres?",
                    file, 1e3 * kLeastApart_m));
  else if (faults.empty() && !see_the_same(calibration.camera, second))
    faults.add(fmt::format(
        "{}: camera2_from_camera: the second camera looks away: it sees nothing of what "
        "the first one sees. Is it the inverse, camera_from_camera2?",
        file));
}

}  // namespace

void check_plausible(const Calibration& calibration, std::string_view file,
                     config::Faults& faults) {
  check_transform("camera_from_tracker", "tracker", calibration.camera_from_tracker, file, faults);
  check_size("projector", calibration.projector.width_px, calibration.projector.height_px, file,
             faults);
  check_camera("camera", calibration.camera, file, faults);
  if (calibration.camera2) check_pair(calibration, file, faults);
  if (!(std::abs(glm::determinant(calibration.projector.from_camera)) > 1e-9))
    faults.add(fmt::format(
        "{}: projector: the rows x, y, w of the homography are linearly dependent", file));
  else if (const auto fault = fault_of_homography(calibration); !fault.empty())
    faults.add(fmt::format("{}: projector: {}", file, fault));
  else
    check_parallax(calibration, file, faults);
}

}  // namespace handcast::calib
