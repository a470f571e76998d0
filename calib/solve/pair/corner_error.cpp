// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/pair/corner_error.hpp"

#include <cmath>

namespace handcast::calib {
namespace {

/// The direction of a pixel of the image, with z = 1.
glm::dvec3 ray_of(const CameraModel& camera, const cv::Point2d& image_px) {
  const auto px = camera.undistort({image_px.x, image_px.y});
  return {(px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px, 1};
}

/// The squared distance of a ray's pixel from a line of the plane z = 1.
double off_line_px2(const glm::dvec3& ray, const glm::dvec3& line, double focal_px) {
  const double off = focal_px * glm::dot(ray, line) / std::hypot(line.x, line.y);
  return off * off;
}

/// The point between two rays where they are nearest to each other. `from`: where the second one
/// begins; the first one begins at 0.
glm::dvec3 between(const glm::dvec3& first, const glm::dvec3& second, const glm::dvec3& from) {
  const double a = glm::dot(first, first), b = glm::dot(first, second),
               c = glm::dot(second, second), d = glm::dot(first, from), e = glm::dot(second, from);
  const double divisor = a * c - b * b;
  const double along_first = (c * d - b * e) / divisor, along_second = (b * d - a * e) / divisor;
  return (along_first * first + from + along_second * second) / 2.0;
}

}  // namespace

std::vector<CornerError> corner_errors(const PairPoints& view, const Cameras& cameras,
                                       const glm::dmat4& second_from_first) {
  const auto placed = place(view.first, cameras[0]);
  if (!placed) return {};
  const auto first_from_board = matrix_of(placed->pose);
  const glm::dmat3 turn(second_from_first);
  const glm::dvec3 move(second_from_first[3]);
  const auto from = -glm::transpose(turn) * move;
  std::vector<CornerError> errors;
  for (std::size_t i = 0; i < view.first.board_m.size(); ++i)
    for (std::size_t j = 0; j < view.second.board_m.size(); ++j) {
      if (view.first.board_m[i] != view.second.board_m[j]) continue;
      const auto here = ray_of(cameras[0], view.first.image_px[i]),
                 there = ray_of(cameras[1], view.second.image_px[j]);
      const auto& m = view.first.board_m[i];
      CornerError error;
      // The essential matrix [t]x R (Hartley & Zisserman 2004, section 9.6).
      error.off_line2_px2 =
          (off_line_px2(there, glm::cross(move, turn * here), cameras[1].fx_px) +
           off_line_px2(here, glm::transpose(turn) * glm::cross(there, move), cameras[0].fx_px)) /
          2;
      error.place_m = glm::dvec3(first_from_board * glm::dvec4(m.x, m.y, m.z, 1));
      error.off_m = between(here, glm::transpose(turn) * there, from) - error.place_m;
      errors.push_back(error);
    }
  return errors;
}

namespace {

constexpr int kParts = 5;

struct Sums {
  double px2 = 0, mm2 = 0;
  int corners = 0;
};

void add(const PairPoints& view, const Cameras& cameras, const glm::dmat4& second_from_first,
         Sums& sums) {
  for (const auto& error : corner_errors(view, cameras, second_from_first)) {
    sums.px2 += error.off_line2_px2;
    sums.mm2 += 1e6 * glm::dot(error.off_m, error.off_m);
    ++sums.corners;
  }
}

}  // namespace

std::optional<PairError> held_out(std::span<const PairPoints> views, const Cameras& cameras,
                                  const PairSolution& solution) {
  Sums sums;
  for (std::size_t part = 0; part < kParts; ++part) {
    std::vector<PairPoints> others;
    PairSolution near{solution.pair, {}, {}};
    for (std::size_t i = 0; i < views.size(); ++i)
      if (i % kParts != part) {
        others.push_back(views[i]);
        near.boards.push_back(solution.boards[i]);
      }
    const auto fit = solve(others, cameras, near);
    if (!fit) return {};
    for (auto i = part; i < views.size(); i += kParts)
      add(views[i], cameras, matrix_of(fit->pair), sums);
  }
  if (sums.corners == 0) return {};
  return PairError{std::sqrt(sums.px2 / sums.corners), std::sqrt(sums.mm2 / sums.corners)};
}

}  // namespace handcast::calib
