// SPDX-License-Identifier: Apache-2.0
#include "tests/calib/solve/screen/rendered_board.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "calib/solve/screen/depth_error.hpp"

namespace handcast::calib::test {
namespace {

constexpr int kParts = 2;  ///< of a pixel, in x and in y

/// Convolves with (outer2, outer1, middle, outer1, outer2) along an axis of this stride.
void blur(std::vector<float>& image, double sigma_px, int stride) {
  std::array<float, 3> weights;
  for (std::size_t i = 0; i < 3; ++i)
    weights[i] =
        static_cast<float>(std::exp(-0.5 * static_cast<double>(i * i) / (sigma_px * sigma_px)));
  const float sum = weights[0] + 2 * (weights[1] + weights[2]);
  for (float& weight : weights) weight /= sum;
  const auto source = image;
  const int count = static_cast<int>(image.size());
  for (int i = 2 * stride; i < count - 2 * stride; ++i) {
    const float* at = source.data() + i;
    image[static_cast<std::size_t>(i)] = weights[0] * at[0] +
                                         weights[1] * (at[-stride] + at[stride]) +
                                         weights[2] * (at[-2 * stride] + at[2 * stride]);
  }
}

/// The undistorted pixels of the parts of all pixels.
const std::vector<glm::dvec2>& undistorted_parts() {
  static const auto parts = [] {
    const auto camera = bent_camera();
    std::vector<glm::dvec2> px;
    for (int y = 0; y < camera.height_px; ++y)
      for (int x = 0; x < camera.width_px; ++x)
        for (int part = 0; part < kParts * kParts; ++part)
          px.push_back(camera.undistort(glm::dvec2(x, y) +
                                        (glm::dvec2(part % kParts, part / kParts) + 0.5) /
                                            static_cast<double>(kParts) -
                                        0.5));
    return px;
  }();
  return parts;
}

/// Share of the light that the board reflects at a place seen by the camera.
double albedo(const Scene& scene, double x_m, double y_m) {
  constexpr double kBlack = 0.07;
  if (x_m >= scene.board_right_m) return 0;
  if (scene.squares_m == 0) return 1;
  const int square = static_cast<int>(std::floor((x_m - scene.print_right_m) / scene.squares_m) +
                                      std::floor((y_m - scene.print_right_m) / scene.squares_m));
  return square & 1 ? kBlack : 1;
}

/// The pixel of the projector's picture that lights a place, or -1.
std::int32_t lit_pixel(const glm::dvec2& projector_px) {
  const auto lit = glm::floor(projector_px + 0.5);
  const bool inside =
      lit.x >= 0 && lit.y >= 0 && lit.x < kProjectorWidth_px && lit.y < kProjectorHeight_px;
  return inside ? static_cast<int>(lit.y) * kProjectorWidth_px + static_cast<int>(lit.x) : -1;
}

}  // namespace

CameraModel bent_camera() {
  CameraModel camera;
  camera.k1 = -0.28;
  return camera;
}

ProjectorModel coaxial_screen() {
  return {reference_rig().projector.from_camera, glm::dvec3(0), kPlane_m};
}

ProjectorModel screen_beside(double baseline_m) { return screen_from({baseline_m, 0, 0}); }

ProjectorModel screen_from(const glm::dvec3& centre_m) {
  const double focal_px = 1653, angle = std::atan2(centre_m.x, kPlane_m);
  const glm::dmat3 lens(focal_px, 0, 0, 0, focal_px, 0, 511.5, 383.5, 1);
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1), angle, glm::dvec3(0, 1, 0)));
  const auto infinite = lens * turn;
  const auto parallax = -infinite * centre_m;
  auto homography = infinite * glm::inverse(bent_camera().matrix());
  homography[2] += parallax / kPlane_m;
  return ProjectorModel{homography, parallax, kPlane_m}.normalised();
}

glm::dvec4 tilted_board(double depth_m, double tilt_rad) {
  const glm::dmat3 turn(
      glm::rotate(glm::dmat4(1), tilt_rad, glm::normalize(glm::dvec3(1, 0.5, 0))));
  return {turn[2], -turn[2].z * depth_m};
}

double depth_of(const glm::dvec4& plane, const CameraModel& camera, const glm::dvec2& px) {
  const glm::dvec3 ray((px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px,
                       1);
  return -plane.w / glm::dot(glm::dvec3(plane), ray);
}

RenderedBoard::RenderedBoard(const ProjectorModel& screen, const glm::dvec4& plane,
                             const Scene& scene)
    : scene_(scene), random_(scene.seed) {
  const auto camera = bent_camera();
  const glm::dvec2 middle(camera.cx_px, camera.cy_px);
  for (int i = 0; i < camera.width_px * camera.height_px; ++i) {
    double reflected = 0;
    for (int part = 0; part < kParts * kParts; ++part) {
      const auto px = undistorted_parts()[lit_by_.size()];
      const double depth_m = depth_of(plane, camera, px);
      const auto place_m = (px - middle) / camera.fx_px * depth_m;
      lit_by_.push_back(lit_pixel(screen.pixel_of(px, depth_m)));
      reflected += albedo(scene, place_m.x, place_m.y) / (kParts * kParts);
    }
    const auto away =
        (glm::dvec2(i % camera.width_px, i / camera.width_px) - middle) / glm::length(middle);
    board_.push_back(static_cast<float>(reflected * (1 - scene.vignetting * glm::dot(away, away))));
  }
  std::normal_distribution<float> normal(0, static_cast<float>(scene.noise));
  for (int i = 0; i < 1 << 19; ++i) noise_.push_back(normal(random_));
}

std::vector<std::uint8_t> RenderedBoard::image_of(const std::vector<std::uint8_t>& picture) {
  const auto count = board_.size();
  std::vector<float> light(count);
  const float gain = static_cast<float>(scene_.contrast) / (255 * kParts * kParts);
  for (std::size_t i = 0; i < count; ++i) {
    int sum = 0;
    for (std::size_t part = 0; part < kParts * kParts; ++part)
      if (const auto from = lit_by_[i * kParts * kParts + part]; from >= 0)
        sum += picture[static_cast<std::size_t>(from)];
    light[i] = board_[i] * (static_cast<float>(scene_.ambient) + gain * static_cast<float>(sum));
  }
  blur(light, scene_.blur_px, 1);
  blur(light, scene_.blur_px, bent_camera().width_px);
  std::vector<std::uint8_t> image(count);
  auto at = random_();
  for (std::size_t i = 0; i < count; ++i) {
    const float grey = light[i] + noise_[(at + i) % noise_.size()];
    image[i] = static_cast<std::uint8_t>(std::clamp(grey + 0.5f, 0.f, 255.f));
  }
  return image;
}

std::vector<GreyView> Shots::views() const {
  std::vector<GreyView> views;
  for (const auto& image : images) views.push_back({image.data(), width_px, height_px, width_px});
  return views;
}

Shots shoot(const GrayCode& code, RenderedBoard& board) {
  Shots shots{{}, bent_camera().width_px, bent_camera().height_px};
  std::vector<std::uint8_t> picture(kProjectorWidth_px * kProjectorHeight_px);
  for (int i = 0; i < code.patterns(); ++i) {
    code.draw(i, picture.data());
    shots.images.push_back(board.image_of(picture));
  }
  return shots;
}

std::vector<Correspondence> seen_points(const CameraModel& camera, const ProjectorModel& screen,
                                        const glm::dvec4& plane, double noise_px, unsigned seed,
                                        int step_px) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<Correspondence> points;
  for (int y = step_px / 2; y < camera.height_px; y += step_px)
    for (int x = step_px / 2; x < camera.width_px; x += step_px) {
      const auto px = camera.undistort(glm::dvec2(x, y));
      const auto lit = screen.pixel_of(px, depth_of(plane, camera, px));
      points.push_back(
          {glm::dvec2(x, y), lit + noise_px * glm::dvec2(noise(random), noise(random)), 1});
    }
  return points;
}

void spoil(std::vector<Correspondence>& points, double share, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(0, 1);
  for (auto& point : points)
    if (anywhere(random) < share)
      point.projector_px = {kProjectorWidth_px * anywhere(random),
                            kProjectorHeight_px * anywhere(random)};
}

double worst_px(const ProjectorModel& believed, const ProjectorModel& truth,
                const CameraModel& camera) {
  double worst = 0;
  for (const auto& error : depth_error(
           believed, truth, camera,
           std::array{kPlane_m - 0.1, kPlane_m - 0.05, kPlane_m, kPlane_m + 0.05, kPlane_m + 0.1}))
    worst = std::max(worst, error.largest_px);
  return worst;
}

}  // namespace handcast::calib::test
