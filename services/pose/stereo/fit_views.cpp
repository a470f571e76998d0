// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/fit_views.hpp"

#include <algorithm>
#include <cmath>

#include "services/pose/lift/anatomy.hpp"
#include "services/pose/lift/levenberg_marquardt.hpp"

namespace handcast::pose::stereo {
namespace {

/// Calls `visit(unknown, finger, k)` for each angle and, with the other base, each bone.
template <class Visit>
void for_each(int base, Visit&& visit) {
  for (int f = 0; f < kFingers; ++f)
    for (int k = 0; k < kAngles; ++k) visit(base + f * kAngles + k, f, k);
}

}  // namespace

HandState moved(HandState state, const Unknowns& step) {
  const glm::dvec3 by(step[0], step[1], step[2]);
  if (const double angle = glm::length(by); angle > 1e-12)
    state.posture.turn = glm::normalize(glm::angleAxis(angle, by / angle) * state.posture.turn);
  state.posture.palm_m += glm::dvec2(step[kPlaceAt], step[kPlaceAt + 1]);
  state.depth_m += step[kPlaceAt + 2];
  for_each(kAnglesAt, [&](int at, int f, int k) { state.posture.angle[f][k] += step[at]; });
  state.posture.log_size += step[kSizeAt];
  for_each(kBonesAt, [&](int at, int f, int k) { state.log_bone[f][k] += step[at]; });
  return state;
}

Unknowns difference(const HandState& from, const HandState& to) {
  glm::dquat turned = to.posture.turn * glm::conjugate(from.posture.turn);
  if (turned.w < 0) turned = -turned;
  const glm::dvec3 axis(turned.x, turned.y, turned.z);
  const double sine = glm::length(axis);
  const glm::dvec3 by = sine > 1e-12 ? axis * (2 * std::atan2(sine, turned.w) / sine) : axis;
  const glm::dvec2 way_m = to.posture.palm_m - from.posture.palm_m;
  Unknowns step{by.x, by.y, by.z, way_m.x, way_m.y, to.depth_m - from.depth_m};
  for_each(kAnglesAt, [&](int at, int f, int k) {
    step[at] = to.posture.angle[f][k] - from.posture.angle[f][k];
  });
  step[kSizeAt] = to.posture.log_size - from.posture.log_size;
  for_each(kBonesAt,
           [&](int at, int f, int k) { step[at] = to.log_bone[f][k] - from.log_bone[f][k]; });
  return step;
}

PosedHand posed(const Skeleton& skeleton, const HandState& state) {
  BoneFactors factors;
  for (int f = 0; f < kFingers; ++f)
    for (int k = 0; k < kAngles; ++k) factors[f][k] = std::exp(state.log_bone[f][k]);
  return skeleton.posed(state.posture, state.depth_m, factors);
}

namespace {

/// The correlation in two views of one direction, and the angle between views at which it has
/// fallen to 1/e of that. Measured with handcast's network on the twin: 0.5 to 0.8 at 8 degrees,
/// 0.2 to 0.6 at 22 degrees.
constexpr double kMost = 0.95, kFalls_rad = 0.3;

}  // namespace

Likeness likeness_of(const Views& views, const glm::dvec3& hand_m) {
  const glm::dmat4& second_from_first = views[1].view_from_first;
  const glm::dmat3 turn(second_from_first);
  const glm::dvec3 centre_m = -glm::transpose(turn) * glm::dvec3(second_from_first[3]);
  const double cosine = glm::dot(glm::normalize(hand_m), glm::normalize(hand_m - centre_m));
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double roll = std::atan2(turn[0][1] - turn[1][0], turn[0][0] + turn[1][1]);
  return {kMost * std::exp(-angle / kFalls_rad), std::cos(roll), std::sin(roll)};
}

namespace {

using Equations = NormalEquations<kUnknowns>;

constexpr double kHuber = 3;  ///< beyond so many standard deviations, residuals count linearly

/// The errors of handcast's network on the twin relative to its landmarks' sigmas, as read() has
/// them: root mean square per axis 0.35 to 0.5.
constexpr double kErrorPerSigma = 0.5;

/// The most columns of one landmark: place and rotation, angles, size, bones.
constexpr int kMostColumns = kAnglesAt + kAngles + 1 + kAngles;

/// The derivatives of the place of one joint.
struct Moves {
  std::array<glm::dvec3, kMostColumns> by;
  std::array<int, kMostColumns> column;
  int count = 0;

  void add(int at, const glm::dvec3& move) {
    column[count] = at;
    by[count++] = move;
  }
};

Moves moves_of(const PosedHand& hand, int landmark) {
  const glm::dvec3 at_m = hand.place_m[msg::kJointOfLandmark[landmark]];
  const glm::dvec3 arm_m = at_m - hand.place_m[kPalm];
  Moves moves;
  moves.add(0, {0, -arm_m.z, arm_m.y});
  moves.add(1, {arm_m.z, 0, -arm_m.x});
  moves.add(2, {-arm_m.y, arm_m.x, 0});
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0);
    unit[axis] = 1;
    moves.add(kPlaceAt + axis, unit);
  }
  const bool in_finger = landmark > 0;
  const int finger = (landmark - 1) / 4, along = in_finger ? (landmark - 1) % 4 : -1;
  for (int a = 0; a < kAngles && std::max(0, a - 1) < along; ++a) {
    const glm::dvec3 pivot_m = hand.place_m[kFirstJoint[finger] + std::max(0, a - 1)];
    moves.add(kAnglesAt + finger * kAngles + a, glm::cross(hand.hinge[finger][a], at_m - pivot_m));
  }
  moves.add(kSizeAt, arm_m);
  for (int k = 0; k <= along; ++k) {
    const int joint = kFirstJoint[finger] + k;
    moves.add(kBonesAt + finger * kAngles + k,
              hand.place_m[joint] - hand.place_m[renderer::kJointParent[joint]]);
  }
  return moves;
}

/// One evaluation of the problem at a state.
struct Problem {
  const Skeleton& skeleton;
  const Views& views;
  const SeenInViews& seen;
  const HandPrior& prior;
  Likeness likeness;   ///< of the views of this hand
  double squares = 0;  ///< of the landmarks' residuals in sigmas, of the last evaluation
  int residuals = 0;

  /// The cost of a state; adds to `equations` if it is given.
  double at(const HandState& state, Equations* equations) {
    const PosedHand hand = posed(skeleton, state);
    double cost = 0;
    squares = 0, residuals = 0;
    for (int i = 0; i < msg::kLandmarks; ++i) cost += landmark(hand, i, equations);
    const Unknowns off = difference(prior.mean, state);
    for (int i = 0; i < kUnknowns; ++i)
      if (prior.variance[i] > 0) cost += square(i, off[i], std::sqrt(prior.variance[i]), equations);
    return cost + anatomy(state.posture.angle, kAnglesAt, equations);
  }

 private:
  /// The residual of a landmark in one view, in sigmas, and its derivatives.
  struct Sighted {
    glm::dvec2 miss;
    std::array<double, kMostColumns> across, down;
  };

  double landmark(const PosedHand& hand, int i, Equations* equations) {
    const Moves moves = equations ? moves_of(hand, i) : Moves{};
    std::array<Sighted, kViews> sighted;
    int count = 0;
    for (int v = 0; v < kViews; ++v)
      if (seen[v] && seen[v]->sigma_px[i] > 0)
        sighted[count++] = sight(hand.place_m[msg::kJointOfLandmark[i]], v, i, moves, equations);
    if (count == 0) return 0;
    const auto squared_of_all = [&] {
      double squared = 0;
      for (int v = 0; v < count; ++v) squared += glm::dot(sighted[v].miss, sighted[v].miss);
      return squared;
    };
    squares += kErrorPerSigma * kErrorPerSigma * squared_of_all();
    residuals += 2 * count;
    if (count == kViews) whiten(sighted, moves.count);
    const double squared = squared_of_all();
    const double sigmas = std::sqrt(squared), most = kHuber * std::sqrt(count);
    const double trust = std::min(1.0, most / std::max(sigmas, 1e-9));
    for (int v = 0; equations && v < count; ++v) {
      equations->add(moves.column.data(), sighted[v].across.data(), moves.count, sighted[v].miss.x,
                     trust);
      equations->add(moves.column.data(), sighted[v].down.data(), moves.count, sighted[v].miss.y,
                     trust);
    }
    return sigmas < most ? 0.5 * squared : most * (sigmas - 0.5 * most);
  }

  Sighted sight(const glm::dvec3& place_m, int v, int i, const Moves& moves,
                const Equations* equations) const {
    const View& view = views[v];
    glm::dvec3 at_m = view.in_view(place_m);
    at_m.z = std::max(at_m.z, View::kNearest_m);
    const double scale = 1 / (kErrorPerSigma * seen[v]->sigma_px[i]);
    Sighted sighted{scale * (view.camera.project(at_m) - seen[v]->px[i]), {}, {}};
    if (v == 1) sighted.miss = likeness.as_first(sighted.miss);
    if (!equations) return sighted;
    const glm::dmat3 turn(view.view_from_first);
    for (int c = 0; c < moves.count; ++c) {
      const glm::dvec3 by = turn * moves.by[c];
      glm::dvec2 moved = glm::dvec2(view.camera.fx_px * (by.x - by.z * at_m.x / at_m.z),
                                    view.camera.fy_px * (by.y - by.z * at_m.y / at_m.z)) *
                         (scale / at_m.z);
      if (v == 1) moved = likeness.as_first(moved);
      sighted.across[c] = moved.x, sighted.down[c] = moved.y;
    }
    return sighted;
  }

  /// Sum and difference of the residuals of both views, each in its own sigmas.
  void whiten(std::array<Sighted, kViews>& sighted, int columns) const {
    const double sum = std::sqrt(0.5 / (1 + likeness.correlation)),
                 apart = std::sqrt(0.5 / (1 - likeness.correlation));
    const auto mix = [&](auto& a, auto& b) {
      const auto first = a;
      a = sum * (first + b);
      b = apart * (first - b);
    };
    mix(sighted[0].miss, sighted[1].miss);
    for (int c = 0; c < columns; ++c) {
      mix(sighted[0].across[c], sighted[1].across[c]);
      mix(sighted[0].down[c], sighted[1].down[c]);
    }
  }
};

/// The longest step for which the linearisation is good.
double most_step(int unknown) {
  if (unknown < kPlaceAt) return 0.8;
  return unknown >= kAnglesAt && unknown < kMoving ? 0.6 : 0.2;
}

}  // namespace

HandFit fit_views(const Skeleton& skeleton, const Views& views, const SeenInViews& seen,
                  const HandPrior& prior, const HandState& start, int steps) {
  Problem problem{skeleton, views, seen, prior,
                  likeness_of(views, {start.posture.palm_m, start.depth_m})};
  const auto best = minimise<kUnknowns>(problem, start, steps, most_step);
  return {best.state, best.cost, best.variance,
          std::sqrt(problem.squares / std::max(problem.residuals, 1))};
}

}  // namespace handcast::pose::stereo
