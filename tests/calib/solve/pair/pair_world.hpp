// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "calib/solve/pair/pair_fit.hpp"
#include "tests/calib/solve/lens/synthetic_views.hpp"

namespace handcast::calib {

/// Two cameras of known truth, and a board that is held where both see it.
struct PairWorld {
  CameraModel first = reference_rig().camera, second = other_lens();
  glm::dmat4 second_from_first = toed_in(0.3, 0.73);
  Board board{BoardKind::charuco, 11, 8, 20};
  int views = 15;
  double noise_px = 0.2;
  double middle_m = 0.73, depth = 0.2;  ///< distance of the board, and its share of change

  static CameraModel other_lens() {
    CameraModel lens;
    lens.fx_px = 1150, lens.fy_px = 1151, lens.cx_px = 352, lens.cy_px = 275;
    lens.k1 = -0.25, lens.k2 = 0.1;
    return lens;
  }
  /// The second camera is so far to the right of the first one and looks at the point straight in
  /// front of that at this distance.
  static glm::dmat4 toed_in(double apart_m, double distance_m) {
    const auto turn = glm::rotate(glm::dmat4(1), std::atan2(apart_m, distance_m), {0, 1, 0});
    return glm::translate(turn, {-apart_m, 0, 0});
  }
};

inline std::vector<PairView> show(const PairWorld& world, unsigned seed) {
  constexpr std::size_t kFewest = 15;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  std::vector<PairView> views;
  while (views.size() < static_cast<std::size_t>(world.views)) {
    const double away_m = world.middle_m * (1 + world.depth * share(random));
    const double right = share(random), down = share(random);
    const glm::dvec3 centre_m =
        away_m * glm::dvec3(0.25 * right * world.first.width_px / world.first.fx_px,
                            0.25 * down * world.first.height_px / world.first.fy_px, 1);
    const double pitch = share(random), yaw = share(random);
    const auto pose =
        held(world.board, centre_m, 0.6 * glm::dvec2(pitch, yaw), 0.3 * share(random));
    PairView view{
        view_of(world.board, world.first, pose, world.noise_px, random),
        view_of(world.board, world.second, world.second_from_first * pose, world.noise_px, random)};
    if (std::min(view.first.ids.size(), view.second.ids.size()) >= kFewest)
      views.push_back(std::move(view));
  }
  return views;
}

inline KnownLenses exact(const PairWorld& world) { return {{{world.first}, {world.second}}}; }

/// Both lenses as a person would have measured them before.
inline Result<KnownLenses> measured(const PairWorld& world, unsigned seed) {
  const Person person{.board = world.board, .noise_px = world.noise_px};
  KnownLenses lenses;
  for (std::size_t i = 0; i < lenses.size(); ++i) {
    const auto& truth = i == 0 ? world.first : world.second;
    const auto views = show(person, truth, 2 * seed + static_cast<unsigned>(i) + 7000);
    const auto fit = fit_lens(views, truth.width_px, truth.height_px);
    if (!fit) return tl::make_unexpected(fit.error());
    lenses[i] = {fit->camera, fit->covariance};
  }
  return lenses;
}

/// How far the middle of the volume is from where it should be in the second camera.
inline double middle_off_mm(const PairWorld& world, const PairFit& fit) {
  const glm::dvec4 middle(fit.middle_m, 1);
  return 1e3 * glm::distance(world.second_from_first * middle, fit.second_from_first * middle);
}

/// A point by what both cameras see of it, in the space of the first one: between the two rays.
inline glm::dvec3 triangulated_m(const PairWorld& world, const PairFit& fit,
                                 const KnownLenses& lenses, const glm::dvec3& true_m) {
  const auto ray_of = [](const CameraModel& truth, const CameraModel& known, const glm::dvec3& m) {
    const auto px = known.undistort(truth.distort(truth.project(m)));
    return glm::dvec3((px.x - known.cx_px) / known.fx_px, (px.y - known.cy_px) / known.fy_px, 1);
  };
  const auto first_from_second = glm::inverse(fit.second_from_first);
  const glm::dvec3 in_second_m(world.second_from_first * glm::dvec4(true_m, 1));
  const auto here = ray_of(world.first, lenses[0].camera, true_m);
  const auto there =
      glm::dmat3(first_from_second) * ray_of(world.second, lenses[1].camera, in_second_m);
  const glm::dvec3 from(first_from_second[3]);
  // Both rays and the shortest line between them: along_here here = from + along_there there + n.
  const auto along = glm::inverse(glm::dmat3(here, -there, glm::cross(here, there))) * from;
  return (along.x * here + from + along.y * there) / 2.0;
}

/// By how much 100 mm in the middle of the volume are mistaken, the worst of three directions.
inline double length_off_mm(const PairWorld& world, const PairFit& fit, const KnownLenses& lenses) {
  double worst_mm = 0;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 half_m(0);
    half_m[axis] = 0.05;
    const glm::dvec3 middle_m(0, 0, world.middle_m);
    const auto length_m = glm::distance(triangulated_m(world, fit, lenses, middle_m + half_m),
                                        triangulated_m(world, fit, lenses, middle_m - half_m));
    worst_mm = std::max(worst_mm, std::abs(1e3 * length_m - 100));
  }
  return worst_mm;
}

/// The second camera in the axes of the first, mm.
inline glm::dvec3 true_place_mm(const PairWorld& world) {
  return 1e3 * glm::dvec3(glm::inverse(world.second_from_first)[3]);
}

}  // namespace handcast::calib
