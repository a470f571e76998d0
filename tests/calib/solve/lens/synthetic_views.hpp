// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "calib/calibration.hpp"
#include "calib/solve/board/board.hpp"
#include "tests/calib/solve/board/held.hpp"

namespace handcast::calib {

/// The corners of a board inside the image, each off by normal noise per axis.
inline BoardView view_of(const Board& board, const CameraModel& camera,
                         const glm::dmat4& camera_from_board, double noise_px,
                         std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  BoardView view;
  const auto points_m = points_of(board);
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const auto px = seen_px(camera, camera_from_board, points_m[i]);
    if (!(px.x > 0 && px.y > 0 && px.x < camera.width_px - 1 && px.y < camera.height_px - 1))
      continue;
    view.ids.push_back(static_cast<int>(i));
    view.board_m.push_back(points_m[i]);
    const double right_px = noise(random) * noise_px;
    view.image_px.push_back(px + glm::dvec2(right_px, noise(random) * noise_px));
  }
  return view;
}

/// What a person shows who follows the advice of Coverage: the board all over the image, tilted by
/// up to 35 degrees, at 0.8 to 1.5 times the distance at which it fills the image.
struct Person {
  Board board{BoardKind::charuco, 10, 7, 20};
  int views = 15;
  double noise_px = 0.2;
  double tilt_rad = 35 * std::numbers::pi / 180;
  double reach = 0.4;  ///< how far the board's middle gets from the image's, in image sizes
};

inline std::vector<BoardView> show(const Person& person, const CameraModel& camera, unsigned seed) {
  constexpr std::size_t kFewest = 15;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  const double fills_m =
      camera.fx_px / camera.width_px * person.board.columns * person.board.square_mm * 1e-3;
  std::vector<BoardView> views;
  while (views.size() < static_cast<std::size_t>(person.views)) {
    const double away_m = fills_m * (1.15 + 0.35 * share(random));
    const double right = share(random), down = share(random);
    const glm::dvec3 centre_m(right * person.reach * camera.width_px / camera.fx_px * away_m,
                              down * person.reach * camera.height_px / camera.fy_px * away_m,
                              away_m);
    const double pitch = share(random), yaw = share(random);
    auto view = view_of(
        person.board, camera,
        held(person.board, centre_m, glm::dvec2(pitch, yaw) * person.tilt_rad, share(random) * 0.3),
        person.noise_px, random);
    if (view.ids.size() >= kFewest) views.push_back(std::move(view));
  }
  return views;
}

/// How far apart two cameras see the same rays, over the image of the true one, in the sense of
/// least squares. The fitted one may be turned: a camera that is turned a little and has its
/// principal point elsewhere sees nearly the same, and the poses of the boards take up the turn.
inline double reprojection_px(const CameraModel& fitted, const CameraModel& truth) {
  const auto fitted_px = [&fitted](const glm::dvec3& ray) {
    return fitted.distort(fitted.project(ray));
  };
  constexpr double kStep_rad = 1e-5;
  glm::dvec3 turn(0);
  double rms_px = 0;
  for (int round = 0; round < 3; ++round) {
    glm::dmat3 normal(0);
    glm::dvec3 slope(0);
    double squares = 0;
    int count = 0;
    for (int y = 0; y < truth.height_px; y += 20)
      for (int x = 0; x < truth.width_px; x += 20) {
        const auto px = truth.undistort({x, y});
        const glm::dvec3 straight((px.x - truth.cx_px) / truth.fx_px,
                                  (px.y - truth.cy_px) / truth.fy_px, 1);
        const auto ray = straight + glm::cross(turn, straight);
        const auto off_px = glm::dvec2(x, y) - fitted_px(ray);
        glm::dmat3x2 by_turn;
        for (int axis = 0; axis < 3; ++axis) {
          glm::dvec3 step(0);
          step[axis] = kStep_rad;
          by_turn[axis] = (fitted_px(ray + glm::cross(step, ray)) - fitted_px(ray)) / kStep_rad;
        }
        normal += glm::transpose(by_turn) * by_turn;
        slope += glm::transpose(by_turn) * off_px;
        squares += glm::dot(off_px, off_px);
        ++count;
      }
    turn += glm::inverse(normal) * slope;
    rms_px = std::sqrt(squares / count);
  }
  return rms_px;
}

}  // namespace handcast::calib
