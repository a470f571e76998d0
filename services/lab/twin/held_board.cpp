// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/held_board.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace handcast::twin {
namespace {

constexpr double kNearest_m = 0.55, kFarthest_m = 0.95;
constexpr double kInside = 0.9;    ///< share of the board that is in the image
constexpr double kFlat_deg = 2;    ///< largest tilt of a board that is held to face the camera
constexpr double kLeast_deg = 12;  ///< smallest tilt of any other
constexpr double kRoll_deg = 25;
constexpr double kScatter = 0.15;  ///< of the direction from the middle of the image
constexpr int kCells = 9;          ///< of the image, three by three

/// Numbers of the stream by place.
enum Draw : std::uint64_t { distance, direction, tilt, roll, right, down };

/// From 0 to 1 with speed and acceleration 0 at both ends.
double smooth(double t) { return t * t * t * (t * (6 * t - 15) + 10); }

/// The distance from which on a facing board fits into the image.
double fitting_m(const calib::CameraModel& camera, const glm::dvec2& half_m) {
  return 2 * std::max(half_m.x * camera.fx_px / camera.width_px,
                      half_m.y * camera.fy_px / camera.height_px);
}

/// The share of a board around `centre_m` that is in the image of a viewer.
double share_inside(const BoardViewer& viewer, const glm::dvec3& centre_m, const glm::dquat& turn,
                    const glm::dvec2& half_m) {
  constexpr int kSteps = 10;
  constexpr double kBehind_m = 0.01;
  const auto& camera = viewer.camera;
  int inside = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const auto at = (glm::dvec2(i % kSteps, i / kSteps) + 0.5) * (2.0 / kSteps) - 1.0;
    const glm::dvec3 point_m(viewer.from_first *
                             glm::dvec4(centre_m + turn * glm::dvec3(at * half_m, 0), 1));
    if (point_m.z < kBehind_m) continue;
    inside += camera.contains(camera.distort(camera.project(point_m)));
  }
  return static_cast<double>(inside) / (kSteps * kSteps);
}

/// The smallest share over all viewers.
double share_inside(std::span<const BoardViewer> viewers, const glm::dvec3& centre_m,
                    const glm::dquat& turn, const glm::dvec2& half_m) {
  double least = 1;
  for (const auto& viewer : viewers)
    least = std::min(least, share_inside(viewer, centre_m, turn, half_m));
  return least;
}

/// The point at this distance that is seen in the image at `towards`: (0, 0) in its middle to
/// (1, 1) in its lower right corner.
glm::dvec3 seen_at_m(const calib::CameraModel& camera, const glm::dvec2& towards,
                     double distance_m) {
  const glm::dvec2 half_px(camera.width_px / 2.0, camera.height_px / 2.0);
  const auto px = camera.undistort(half_px - 0.5 + towards * half_px);
  return distance_m *
         glm::dvec3((px.x - camera.cx_px) / camera.fx_px, (px.y - camera.cy_px) / camera.fy_px, 1);
}

}  // namespace

HeldBoard::HeldBoard(std::span<const BoardViewer> viewers, const BoardOutline& board, int seed,
                     double hold_s)
    : random_(seed, Stream::board),
      hold_s_(hold_s),
      centre_m_((board.from_m + board.to_m) / 2.0),
      half_m_(glm::abs(board.to_m - board.from_m) / 2.0) {
  for (std::uint64_t i = 0; i < kPlaces; ++i) places_.push_back(make_place(i, viewers));
}

HeldBoard::HeldBoard(const calib::CameraModel& camera, const BoardOutline& board, int seed,
                     double hold_s)
    : HeldBoard(std::array{BoardViewer{camera}}, board, seed, hold_s) {}

glm::dquat HeldBoard::turn_at(std::uint64_t i) const {
  const bool flat = i % 5 == 0;
  const double share = random_.uniform(i, tilt);
  const double tilt_deg = flat ? kFlat_deg * share : glm::mix(kLeast_deg, kMost_deg, share);
  const double around =
      2 * std::numbers::pi * (static_cast<double>(i * 7 % 12) + random_.uniform(i, direction)) / 12;
  const glm::dvec3 axis(std::cos(around), std::sin(around), 0);
  return glm::angleAxis(glm::radians(tilt_deg), axis) *
         glm::angleAxis(glm::radians(kRoll_deg * random_.spread(i, roll)), glm::dvec3(0, 0, 1));
}

/// Moves the board from the middle of the first image towards one cell, as far as kInside permits.
/// Cells, distances and tilts take turns in independent orders.
HeldBoard::Place HeldBoard::make_place(std::uint64_t i,
                                       std::span<const BoardViewer> viewers) const {
  const auto& camera = viewers.front().camera;
  double nearest_m = kNearest_m;
  for (const auto& viewer : viewers)
    nearest_m = std::max(nearest_m, fitting_m(viewer.camera, half_m_));
  const double farthest_m = std::max(kFarthest_m, 1.3 * nearest_m);
  const double level =
      (static_cast<double>(i * 11 % kPlaces) + random_.uniform(i, distance)) / kPlaces;
  const double distance_m = glm::mix(nearest_m, farthest_m, level);
  const auto turn = turn_at(i);

  const auto cell = static_cast<int>(i * 4 % kCells);
  const auto towards = glm::dvec2(cell % 3 - 1, cell / 3 - 1) +
                       kScatter * glm::dvec2(random_.spread(i, right), random_.spread(i, down));
  double inside = 0, outside = 1;
  for (int step = 0; step < 12; ++step) {
    const double middle = (inside + outside) / 2;
    const auto centre_m = seen_at_m(camera, middle * towards, distance_m);
    (share_inside(viewers, centre_m, turn, half_m_) >= kInside ? inside : outside) = middle;
  }
  return {seen_at_m(camera, inside * towards, distance_m), turn};
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
