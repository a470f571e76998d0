// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/pose/lift/anatomy.hpp"
#include "services/pose/lift/hand_steps.hpp"

namespace handcast::pose {
namespace {

using calib::NormalEquations;

constexpr double kHuber = 3;  ///< beyond so many standard deviations, residuals count linearly
constexpr double kUsualSizeSd = 0.25;

/// The point, or one at the least depth at which the projection is used.
glm::dvec3 in_front(glm::dvec3 at_m) {
  constexpr double kNearest_m = 0.05;
  at_m.z = std::max(at_m.z, kNearest_m);
  return at_m;
}

constexpr int column_of(int finger, int angle) { return kFirstAngle + finger * kAngles + angle; }

/// What is seen and known of a hand.
struct Problem {
  const Skeleton& skeleton;
  const calib::CameraModel& camera;
  double distance_m;
  const SeenHand& seen;
  const Prior& prior;

  NormalEquations equations_at(const Posture& posture) const {
    const PosedHand hand = skeleton.posed(posture, distance_m);
    auto equations = NormalEquations::zero(kUnknowns);
    for (int i = 0; i < msg::kLandmarks; ++i)
      if (seen.sigma_px[i] > 0) add_landmark(hand, i, equations);
    expect(kSizeUnknown, posture.log_size - prior.usual_log_size, kUsualSizeSd, equations);
    const Unknowns off = difference(prior.mean, posture);
    for (int i = 0; i < kUnknowns; ++i)
      if (prior.variance[i] > 0) expect(i, off[i], std::sqrt(prior.variance[i]), equations);
    add_anatomy(posture.angle, kFirstAngle, equations);
    return equations;
  }

 private:
  void add_landmark(const PosedHand& hand, int i, NormalEquations& equations) const {
    const glm::dvec3 at_m = hand.place_m[msg::kJointOfLandmark[i]];
    const glm::dvec2 miss_px = seen.px[i] - camera.project(in_front(at_m));
    const double sigmas = glm::length(miss_px) / seen.sigma_px[i];
    equations.cost += sigmas < kHuber ? 0.5 * sigmas * sigmas : kHuber * (sigmas - 0.5 * kHuber);
    const double trust = std::min(1.0, kHuber / std::max(sigmas, 1e-9));
    const double weight = trust / (seen.sigma_px[i] * seen.sigma_px[i]);
    const glm::dvec3 arm_m = at_m - hand.place_m[kPalm];
    Moves moves;
    moves.add_turn(arm_m);
    moves.add(kPlaceUnknown, {1, 0, 0});
    moves.add(kPlaceUnknown + 1, {0, 1, 0});
    moves.add(kSizeUnknown, arm_m);
    moves.add_angles(hand, i, column_of((i - 1) / 4, 0));
    const glm::dmat3x2 jacobian_px_per_m = camera.jacobian_px_per_m(in_front(at_m));
    std::array<double, Moves::kMost> across, down;
    for (int c = 0; c < moves.count; ++c) {
      const glm::dvec2 way_px = jacobian_px_per_m * moves.by[c];
      across[c] = way_px.x;
      down[c] = way_px.y;
    }
    const auto columns = std::span(moves.columns).first(moves.count);
    equations.add(columns, across, miss_px.x, weight);
    equations.add(columns, down, miss_px.y, weight);
  }
};

/// The longest step for which the linearisation is good. It is good for any shift in the image.
double most_step(int unknown) {
  if (unknown < kPlaceUnknown) return 0.8;
  if (unknown < kSizeUnknown) return std::numeric_limits<double>::max();
  return unknown == kSizeUnknown ? 0.3 : 0.6;
}

}  // namespace

Posture moved(Posture posture, const Unknowns& step) {
  posture.turn = turned_by(posture.turn, {step[0], step[1], step[2]});
  posture.palm_m += glm::dvec2(step[kPlaceUnknown], step[kPlaceUnknown + 1]);
  posture.log_size += step[kSizeUnknown];
  for (int f = 0; f < kFingers; ++f)
    for (int a = 0; a < kAngles; ++a) posture.angle[f][a] += step[column_of(f, a)];
  return posture;
}

Unknowns difference(const Posture& from, const Posture& to) {
  const glm::dvec3 by = turn_between(from.turn, to.turn);
  const glm::dvec2 way_m = to.palm_m - from.palm_m;
  Unknowns step{by.x, by.y, by.z, way_m.x, way_m.y, to.log_size - from.log_size};
  for (int f = 0; f < kFingers; ++f)
    for (int a = 0; a < kAngles; ++a) step[column_of(f, a)] = to.angle[f][a] - from.angle[f][a];
  return step;
}

Fit fit_posture(const Skeleton& skeleton, const calib::CameraModel& camera, double distance_m,
                const SeenHand& seen, const Prior& prior, const Posture& start, int steps) {
  const Problem problem{skeleton, camera, distance_m, seen, prior};
  Fit fit{.posture = start};
  const auto equations_at = [&](const Posture& posture) { return problem.equations_at(posture); };
  const auto equations = fit_hand<Unknowns>(fit.posture, steps, equations_at, most_step);
  fit.cost = equations.cost;
  fit.variance = variances_of<Unknowns>(equations);
  return fit;
}

namespace {

constexpr double kTilt_rad = 0.45;
constexpr double kBentAtRest_rad = 0.3;
constexpr int kIndexKnuckle = 5, kMiddleKnuckle = 9, kLittleKnuckle = 17;  ///< landmarks

/// Camera from hand: the hand's -z axis along `along` in the image, its back towards the camera or
/// away from it.
glm::dmat3 facing(glm::dvec2 along, bool shows_back) {
  const glm::dvec3 z(-along, 0), y(0, 0, shows_back ? -1 : 1);
  return {glm::cross(y, z), y, z};
}

}  // namespace

std::array<Posture, 4> starts_for(const Skeleton& skeleton, const calib::CameraModel& camera,
                                  double distance_m, const SeenHand& seen, double log_size) {
  const glm::dvec2 palm_px = 0.5 * (seen.px[0] + seen.px[kMiddleKnuckle]);
  glm::dvec2 along = seen.px[kMiddleKnuckle] - seen.px[0];
  along = glm::length(along) > 1e-3 ? glm::normalize(along) : glm::dvec2(0, -1);
  const double index_to_right =
      glm::dot(seen.px[kIndexKnuckle] - seen.px[kLittleKnuckle], glm::dvec2(-along.y, along.x));
  const int index = msg::kJointOfLandmark[kIndexKnuckle],
            little = msg::kJointOfLandmark[kLittleKnuckle];
  const bool index_at_plus_x = skeleton.at_rest_m(index).x > skeleton.at_rest_m(little).x;
  // With the back to the camera, the hand's x axis points to the right of `along`.
  const glm::dmat3 turn = facing(along, (index_to_right > 0) == index_at_plus_x);

  Posture start;
  start.palm_m = (palm_px - glm::dvec2(camera.cx_px, camera.cy_px)) /
                 glm::dvec2(camera.fx_px, camera.fy_px) * distance_m;
  start.log_size = log_size;
  start = with_fingers_at_rest(start);
  std::array<Posture, 4> starts;
  for (int i = 0; i < 4; ++i) {
    const glm::dquat nod = glm::angleAxis(i & 1 ? kTilt_rad : -kTilt_rad, glm::dvec3(1, 0, 0));
    const glm::dquat roll = glm::angleAxis(i & 2 ? kTilt_rad : -kTilt_rad, glm::dvec3(0, 0, 1));
    starts[i] = start;
    starts[i].turn = glm::normalize(glm::quat_cast(turn) * nod * roll);
  }
  return starts;
}

Posture mirrored_in_depth(const Posture& posture) {
  const glm::dmat3 turn = glm::mat3_cast(posture.turn);
  const glm::dmat3 depth(1, 0, 0, 0, 1, 0, 0, 0, -1), back(1, 0, 0, 0, -1, 0, 0, 0, 1);
  Posture other = with_fingers_at_rest(posture);
  other.turn = glm::normalize(glm::quat_cast(depth * turn * back));
  return other;
}

Posture with_fingers_at_rest(Posture posture) {
  posture.angle = {};
  for (int f = 1; f < kFingers; ++f) posture.angle[f] = {0, kBentAtRest_rad, kBentAtRest_rad, 0.2};
  return posture;
}

}  // namespace handcast::pose
