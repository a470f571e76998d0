// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "calib/board/draw_board.hpp"
#include "calib/calibration.hpp"
#include "tests/calib/board/held.hpp"

namespace handcast::calib {

/// What a camera sees, and how well.
struct Shot {
  CameraModel camera;
  glm::dmat4 camera_from_board{1};
  double black = 15, white = 200, background = 90;
  double noise = 2, blur_px = 1;
  unsigned seed = 1;
};

/// A picture of the board as it was drawn, 2 x 2 rays for a pixel.
inline GreyPicture photograph(const Board& board, const Shot& shot) {
  constexpr int kPerSquare_px = 48, kRays = 2;
  const auto drawn = draw_board(board, kPerSquare_px);
  const auto& camera = shot.camera;
  const cv::Mat1b drawing(drawn.height_px, drawn.width_px,
                          const_cast<std::uint8_t*>(drawn.pixels.data()));
  cv::Mat2f from(camera.height_px * kRays, camera.width_px * kRays);
  const auto& pose = shot.camera_from_board;
  const glm::dmat3 plane{glm::dvec3(pose[0]), glm::dvec3(pose[1]), glm::dvec3(pose[3])};
  const auto to_plane = glm::inverse(camera.matrix() * plane);
  for (int y = 0; y < from.rows; ++y)
    for (int x = 0; x < from.cols; ++x) {
      const auto px = camera.undistort((glm::dvec2(x, y) + 0.5) / double{kRays} - 0.5);
      const auto hit = to_plane * glm::dvec3(px, 1);
      const auto at = (glm::dvec2(hit) / hit.z * 1e3 / board.square_mm + 0.5) *
                          double{kPerSquare_px} - 0.5;
      from(y, x) = cv::Vec2f(static_cast<float>(at.x), static_cast<float>(at.y));
    }
  cv::Mat1f drawing_f, fine, image;
  drawing.convertTo(drawing_f, CV_32F, (shot.white - shot.black) / 255, shot.black);
  cv::remap(drawing_f, fine, from, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            shot.background);
  cv::resize(fine, image, {camera.width_px, camera.height_px}, 0, 0, cv::INTER_AREA);
  if (shot.blur_px > 0) cv::GaussianBlur(image, image, {}, shot.blur_px);
  std::mt19937 random(shot.seed);
  std::normal_distribution<float> noise(0, static_cast<float>(shot.noise));
  GreyPicture picture{camera.width_px, camera.height_px, {}};
  for (const float grey : image)
    picture.pixels.push_back(cv::saturate_cast<std::uint8_t>(
        grey + (shot.noise > 0 ? noise(random) : 0)));
  return picture;
}

}  // namespace handcast::calib
