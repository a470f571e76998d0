// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "calib/calibration.hpp"
#include "calib/solve/board/draw_board.hpp"
#include "tests/calib/solve/board/held.hpp"

namespace handcast::calib {

/// What a camera sees, and how well.
struct Shot {
  CameraModel camera;
  glm::dmat4 camera_from_board{1};
  double black = 15, white = 200, background = 90;
  double noise = 2, blur_px = 1;
  unsigned seed = 1;
};

/// Where each pixel of the camera looks, in pixels of a drawing of the board.
inline cv::Mat2f sight_of(const Board& board, const Shot& shot, int px_per_square) {
  const auto& pose = shot.camera_from_board;
  const glm::dmat3 plane{glm::dvec3(pose[0]), glm::dvec3(pose[1]), glm::dvec3(pose[3])};
  const auto to_plane = glm::inverse(shot.camera.matrix() * plane);
  cv::Mat2f sight(shot.camera.height_px, shot.camera.width_px);
  for (int y = 0; y < sight.rows; ++y)
    for (int x = 0; x < sight.cols; ++x) {
      const auto hit = to_plane * glm::dvec3(shot.camera.undistort({x, y}), 1);
      const auto squares = glm::dvec2(hit) / hit.z * 1e3 / board.square_mm + 0.5;
      const auto at = squares * static_cast<double>(px_per_square) - 0.5;
      sight(y, x) = cv::Vec2f(static_cast<float>(at.x), static_cast<float>(at.y));
    }
  return sight;
}

/// A picture of the board as draw_board() draws it; a pixel is the mean of 3 x 3 points.
inline GreyPicture photograph(const Board& board, const Shot& shot) {
  constexpr int kPerSquare_px = 48, kPoints = 3;
  const cv::Size size(shot.camera.width_px, shot.camera.height_px);
  auto drawn = draw_board(board, kPerSquare_px);
  cv::Mat1f drawing, fine, image;
  cv::Mat1b(drawn.height_px, drawn.width_px, drawn.pixels.data())
      .convertTo(drawing, CV_32F, (shot.white - shot.black) / 255, shot.black);
  cv::Mat2f sight;
  cv::resize(sight_of(board, shot, kPerSquare_px), sight, size * kPoints);
  cv::remap(drawing, fine, sight, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            shot.background);
  cv::resize(fine, image, size, 0, 0, cv::INTER_AREA);
  if (shot.blur_px > 0) cv::GaussianBlur(image, image, {}, shot.blur_px);
  std::mt19937 random(shot.seed);
  std::normal_distribution<float> noise(0, 1);
  GreyPicture picture{size.width, size.height, {}};
  for (const float grey : image)
    picture.pixels.push_back(
        cv::saturate_cast<std::uint8_t>(grey + static_cast<float>(shot.noise) * noise(random)));
  return picture;
}

}  // namespace handcast::calib
