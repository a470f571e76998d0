// SPDX-License-Identifier: Apache-2.0
#include "services/camera/leap/lens_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calib/least_squares/levenberg_marquardt.hpp"
#include "calib/least_squares/normal_equations.hpp"

namespace handcast::camera::leap {
namespace {

/// The sensor has 752 columns; images of 640 are cut from its middle.
constexpr double kFullHeight_px = 480;
constexpr int kGrid = 40;
/// Rays further from the axis, 80 degrees, are not fitted.
constexpr double kSteepest = 5.67;

/// A ray and where the eye's own model has its image.
struct Sample {
  glm::dvec2 slope, image_px;
};

/// fx, fy, cx, cy, k1, k2, p1, p2, k3.
constexpr std::size_t kParameters = 9;
using Parameters = std::array<double, kParameters>;

calib::CameraModel camera_of(const Parameters& p, int width_px, int height_px) {
  return {width_px, height_px, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]};
}

/// Image points over the whole image, on the border, too.
std::vector<Sample> samples_of(const EyeCalibration& eye, const calib::CameraModel& plain) {
  std::vector<Sample> samples;
  for (int row = 0; row <= kGrid; ++row)
    for (int column = 0; column <= kGrid; ++column) {
      const glm::dvec2 at_px(column * (plain.width_px - 1.) / kGrid,
                             row * (plain.height_px - 1.) / kGrid);
      const glm::dvec2 image((at_px.x - plain.cx_px) / plain.fx_px,
                             (at_px.y - plain.cy_px) / plain.fy_px);
      const auto slope = eye.ray_of(image);
      const double x = slope.x, y = slope.y, r2 = glm::dot(slope, slope);
      if (!(r2 < kSteepest * kSteepest)) continue;
      const auto [p1, p2] = std::pair(eye.tangential.x, eye.tangential.y);
      const glm::dvec2 bent(2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                            p1 * (r2 + 2 * y * y) + 2 * p2 * x * y);
      samples.push_back({slope, at_px + bent * glm::dvec2(plain.fx_px, plain.fy_px)});
    }
  return samples;
}

/// Where the model has the image of a ray, and its derivatives by the parameters.
struct Projected {
  glm::dvec2 image_px;
  std::array<glm::dvec2, kParameters> slope;
};

Projected project(const Parameters& p, const glm::dvec2& ray) {
  const double x = ray.x, y = ray.y, r2 = x * x + y * y;
  const double radial = 1 + r2 * (p[4] + r2 * (p[5] + r2 * p[8]));
  const glm::dvec2 bent(x * radial + 2 * p[6] * x * y + p[7] * (r2 + 2 * x * x),
                        y * radial + p[6] * (r2 + 2 * y * y) + 2 * p[7] * x * y);
  const glm::dvec2 focal(p[0], p[1]), outward = focal * ray;
  return {focal * bent + glm::dvec2(p[2], p[3]),
          {glm::dvec2(bent.x, 0), glm::dvec2(0, bent.y), glm::dvec2(1, 0), glm::dvec2(0, 1),
           outward * r2, outward * r2 * r2, focal * glm::dvec2(2 * x * y, r2 + 2 * y * y),
           focal * glm::dvec2(r2 + 2 * x * x, 2 * x * y), outward * r2 * r2 * r2}};
}

calib::NormalEquations equations_at(const Parameters& p, const std::vector<Sample>& samples) {
  constexpr std::array kColumns{0, 1, 2, 3, 4, 5, 6, 7, 8};
  auto equations = calib::NormalEquations::zero(kParameters);
  for (const auto& [slope, image_px] : samples) {
    const auto projected = project(p, slope);
    const auto off = image_px - projected.image_px;
    equations.cost += glm::dot(off, off);
    for (int axis = 0; axis < 2; ++axis) {
      Parameters derivatives;
      std::ranges::transform(projected.slope, derivatives.begin(),
                             [axis](const glm::dvec2& by) { return by[axis]; });
      equations.add(kColumns, derivatives, off[axis], 1);
    }
  }
  return equations;
}

void judge(LensFit& fit, const std::vector<Sample>& samples, const Parameters& parameters) {
  double sum = 0, inner_sum = 0;
  int inner = 0;
  const glm::dvec2 size_px(fit.camera.width_px, fit.camera.height_px);
  for (const auto& [slope, image_px] : samples) {
    const double off_px = glm::distance(project(parameters, slope).image_px, image_px);
    sum += off_px * off_px;
    fit.worst_px = std::max(fit.worst_px, off_px);
    const auto from_middle = glm::abs(image_px / size_px - 0.5);
    if (std::max(from_middle.x, from_middle.y) > 0.25) continue;
    inner_sum += off_px * off_px;
    ++inner;
  }
  fit.rms_px = std::sqrt(sum / static_cast<double>(samples.size()));
  fit.inner_rms_px = std::sqrt(inner_sum / std::max(inner, 1));
}

}  // namespace

Result<LensFit> fit_lens(const EyeCalibration& eye, int width_px, int height_px) {
  const double rows = height_px / kFullHeight_px;
  const Parameters start{eye.focal_px, eye.focal_px * rows, width_px / 2. + eye.offset_px.x,
                         (kFullHeight_px / 2 + eye.offset_px.y) * rows};
  const auto samples = samples_of(eye, camera_of(start, width_px, height_px));
  if (samples.size() < kParameters * 10)
    return fail(Errc::bad_data, "the controller's lens sees almost nothing within 80 degrees");
  auto parameters = start;
  calib::minimise(
      parameters, {.steps = 100, .done = 1e-9},
      [&](const Parameters& at) { return equations_at(at, samples); },
      [](Parameters p, const auto& step) {
        for (std::size_t i = 0; i < kParameters; ++i) p[i] += step[static_cast<Eigen::Index>(i)];
        return p;
      });
  LensFit fitted{.camera = camera_of(parameters, width_px, height_px)};
  judge(fitted, samples, parameters);
  if (!std::isfinite(fitted.rms_px) || fitted.worst_px > width_px / 4. || fitted.camera.folds())
    return fail(Errc::bad_data,
                fmt::format("no camera model comes near the controller's lens; the nearest one is "
                            "{:.3g} px off (worst {:.3g} px)",
                            fitted.rms_px, fitted.worst_px));
  return fitted;
}

Result<std::string> calibration_file_of(const ControllerCalibration& calibration,
                                        const std::string& serial, config::Eye eye, int width_px,
                                        int height_px) {
  const bool is_left = eye == config::Eye::left;
  const auto left = fit_lens(calibration.left, width_px, height_px),
             right = fit_lens(calibration.right, width_px, height_px);
  if (!left) return fail_in("left eye", left.error());
  if (!right) return fail_in("right eye", right.error());
  const auto &lens = is_left ? left : right, &other = is_left ? right : left;
  const auto from_left = right_from_left(calibration);
  calib::Calibration file = calib::reference_rig();
  file.camera_device = serial;
  file.camera = lens->camera;
  file.camera2 = {serial, other->camera, is_left ? from_left : glm::inverse(from_left)};
  file.camera_from_tracker = glm::dmat4(1);
  file.projector.from_camera =
      glm::dmat3(file.projector.width_px / static_cast<double>(width_px), 0, 0, 0,
                 file.projector.height_px / static_cast<double>(height_px), 0, 0, 0, 1);
  file.projector.parallax = glm::dvec3(0);
  file.made = {.lens = fmt::format("the {} eye's, from the controller's memory; this model is "
                                   "{:.2f} px off (worst {:.2f}, inner half {:.2f})",
                                   is_left ? "left" : "right", lens->rms_px, lens->worst_px,
                                   lens->inner_rms_px)};
  return calib::print_calibration(file);
}

}  // namespace handcast::camera::leap
