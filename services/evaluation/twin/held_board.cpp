// SPDX-License-Identifier: Apache-2.0
#include "services/evaluation/twin/held_board.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace handcast::twin {
namespace {

constexpr double kNearest_m = 0.55, kFarthest_m = 0.95;
constexpr double kBeyond = 0.12;  ///< share of the half board that may be outside the image
constexpr double kRoll_deg = 25;
constexpr int kCells = 9;  ///< of the image, three by three

/// Numbers of the stream by place.
enum Draw : std::uint64_t { distance, direction, tilt, roll, shift_x, shift_y };

/// From 0 to 1 with speed and acceleration 0 at both ends.
double smooth(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

/// The distance from which on a facing board fits into the image.
double fitting_m(const calib::CameraModel& camera, const glm::dvec2& half_m) {
  return 2 * std::max(half_m.x * camera.fx_px / camera.width_px,
                      half_m.y * camera.fy_px / camera.height_px);
}

/// Half the size of the board's picture, px, if its centre is at this distance on the optical axis.
glm::dvec2 half_extent_px(const calib::CameraModel& camera, const glm::dquat& turn,
                          const glm::dvec2& half_m, double distance_m) {
  glm::dvec2 most(0);
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0}) {
      const auto corner = turn * glm::dvec3(x * half_m.x, y * half_m.y, 0);
      const auto px = camera.project(corner + glm::dvec3(0, 0, distance_m));
      most = glm::max(most, glm::abs(px - glm::dvec2(camera.cx_px, camera.cy_px)));
    }
  return most;
}

}  // namespace

HeldBoard::HeldBoard(const calib::CameraModel& camera, const BoardOutline& board, int seed,
                     double hold_s)
    : random_(seed, Stream::board),
      hold_s_(hold_s),
      centre_m_((board.from_m + board.to_m) / 2.0),
      half_m_(glm::abs(board.to_m - board.from_m) / 2.0) {
  for (int i = 0; i < kPlaces; ++i) places_.push_back(make_place(i, camera));
}

/// The cells of the image are visited in an order that is not that of the distances and tilts.
HeldBoard::Place HeldBoard::make_place(int i, const calib::CameraModel& camera) const {
  const auto index = static_cast<std::uint64_t>(i);
  const double nearest_m = std::max(kNearest_m, fitting_m(camera, half_m_));
  const double farthest_m = std::max(kFarthest_m, 1.3 * nearest_m);
  const double level = (i * 11 % kPlaces + random_.uniform(index, distance)) / kPlaces;
  const double distance_m = nearest_m + (farthest_m - nearest_m) * level;

  const bool flat = i % 5 == 0;
  const double around = 2 * std::numbers::pi * (i * 7 % 12 + random_.uniform(index, direction)) / 12;
  const double by_deg = flat ? 2 * random_.uniform(index, tilt)
                             : 12 + (kMost_deg - 12) * random_.uniform(index, tilt);
  const glm::dquat turn =
      glm::angleAxis(glm::radians(by_deg), glm::dvec3(std::cos(around), std::sin(around), 0)) *
      glm::angleAxis(glm::radians(kRoll_deg * random_.spread(index, roll)), glm::dvec3(0, 0, 1));

  const int cell = i * 4 % kCells;
  const glm::dvec2 towards =
      glm::dvec2(cell % 3 - 1, cell / 3 - 1) +
      0.25 * glm::dvec2(random_.spread(index, shift_x), random_.spread(index, shift_y));
  const glm::dvec2 half_image(camera.width_px / 2.0, camera.height_px / 2.0);
  const auto half_board = half_extent_px(camera, turn, half_m_, distance_m);
  const auto room = glm::max(half_image - half_board, 0.0) + kBeyond * half_board;
  const auto px = half_image - 0.5 + glm::clamp(towards, -1.0, 1.0) * room;
  const auto undistorted = camera.undistort(px);
  return {distance_m * glm::dvec3((undistorted.x - camera.cx_px) / camera.fx_px,
                                  (undistorted.y - camera.cy_px) / camera.fy_px, 1),
          turn};
}

glm::dvec3 HeldBoard::tremor_m(double seconds) const {
  glm::dvec3 offset(0);
  for (std::uint64_t axis = 0; axis < 3; ++axis)
    for (std::uint64_t wave = 0; wave < 2; ++wave) {
      const std::uint64_t id = kPlaces + 2 * axis + wave;
      const double hz = 5 + 5 * random_.uniform(id, 0);  // physiological tremor: 5 to 10 Hz
      const double turns = hz * seconds + random_.uniform(id, 1);
      offset[static_cast<glm::length_t>(axis)] +=
          kTremor_m * std::sin(2 * std::numbers::pi * turns);
    }
  return offset;
}

glm::dmat4 HeldBoard::camera_from_board(double seconds) const {
  const double period_s = hold_s_ + kMove_s;
  const double round_s = kPlaces * period_s;
  const double at_s = seconds - round_s * std::floor(seconds / round_s);
  const int i = std::min(static_cast<int>(at_s / period_s), kPlaces - 1);
  const Place& here = places_[static_cast<std::size_t>(i)];
  const Place& next = places_[static_cast<std::size_t>((i + 1) % kPlaces)];
  const double share = smooth(std::clamp((at_s - i * period_s - hold_s_) / kMove_s, 0.0, 1.0));
  const auto turn = glm::slerp(here.turn, next.turn, share);
  const auto centre_m = glm::mix(here.centre_m, next.centre_m, share) + tremor_m(seconds);
  glm::dmat4 pose = glm::mat4_cast(turn);
  pose[3] = glm::dvec4(centre_m - turn * glm::dvec3(centre_m_, 0), 1);
  return pose;
}

}  // namespace handcast::twin
