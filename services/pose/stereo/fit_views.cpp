// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/fit_views.hpp"

#include <algorithm>
#include <cmath>

#include "services/pose/lift/anatomy.hpp"
#include "services/pose/lift/normal_equations.hpp"

namespace handcast::pose::stereo {
namespace {

using Equations = NormalEquations<kUnknowns>;

constexpr double kHuber = 3;  ///< beyond so many standard deviations, residuals count linearly

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
  double squares = 0;  ///< of the landmarks' residuals in sigmas, of the last evaluation
  int residuals = 0;

  /// The cost of a state; adds to `equations` if it is given.
  double at(const HandState& state, Equations* equations) {
    const PosedHand hand = posed(skeleton, state);
    double cost = 0;
    squares = 0, residuals = 0;
    for (int i = 0; i < msg::kLandmarks; ++i) {
      const Moves moves = equations ? moves_of(hand, i) : Moves{};
      for (int v = 0; v < kViews; ++v)
        if (seen[v] && seen[v]->sigma_px[i] > 0)
          cost += landmark(hand, views[v], *seen[v], i, moves, equations);
    }
    const Unknowns off = difference(prior.mean, state);
    for (int i = 0; i < kUnknowns; ++i)
      if (prior.variance[i] > 0) cost += square(i, off[i], std::sqrt(prior.variance[i]), equations);
    return cost + anatomy(state.posture.angle, kAnglesAt, equations);
  }

 private:
  double landmark(const PosedHand& hand, const View& view, const SeenHand& seen_hand, int i,
                  const Moves& moves, Equations* equations) {
    glm::dvec3 at_m = view.in_view(hand.place_m[msg::kJointOfLandmark[i]]);
    at_m.z = std::max(at_m.z, View::kNearest_m);
    const glm::dvec2 miss_px = view.camera.project(at_m) - seen_hand.px[i];
    const double sigma_px = seen_hand.sigma_px[i];
    const double sigmas = glm::length(miss_px) / sigma_px;
    squares += sigmas * sigmas;
    residuals += 2;
    if (equations) {
      const double trust = std::min(1.0, kHuber / std::max(sigmas, 1e-9));
      derive(view, at_m, miss_px, trust / (sigma_px * sigma_px), moves, *equations);
    }
    return sigmas < kHuber ? 0.5 * sigmas * sigmas : kHuber * (sigmas - 0.5 * kHuber);
  }

  static void derive(const View& view, const glm::dvec3& at_m, glm::dvec2 miss_px, double weight,
                     const Moves& moves, Equations& equations) {
    const glm::dmat3 turn(view.view_from_first);
    std::array<double, kMostColumns> across, down;
    for (int c = 0; c < moves.count; ++c) {
      const glm::dvec3 by = turn * moves.by[c];
      across[c] = view.camera.fx_px * (by.x - by.z * at_m.x / at_m.z) / at_m.z;
      down[c] = view.camera.fy_px * (by.y - by.z * at_m.y / at_m.z) / at_m.z;
    }
    equations.add(moves.column.data(), across.data(), moves.count, miss_px.x, weight);
    equations.add(moves.column.data(), down.data(), moves.count, miss_px.y, weight);
  }
};

/// The step, shortened to what the linearisation is good for.
Unknowns cautious(Unknowns step) {
  for (int i = 0; i < kUnknowns; ++i) {
    const double most = i < kPlaceAt ? 0.8 : i < kAnglesAt ? 0.2 : i < kMoving ? 0.6 : 0.2;
    step[i] = std::clamp(step[i], -most, most);
  }
  return step;
}

}  // namespace

HandFit fit_views(const Skeleton& skeleton, const Views& views, const SeenInViews& seen,
                  const HandPrior& prior, const HandState& start, int steps) {
  Problem problem{skeleton, views, seen, prior};
  HandFit fit{start, problem.at(start, nullptr), {}, 0};
  double damping = 1e-3;
  for (int i = 0; i < steps; ++i) {
    Equations equations;
    problem.at(fit.state, &equations);
    const auto step = equations.step(damping);
    const HandState next = step ? moved(fit.state, cautious(*step)) : fit.state;
    const double cost = problem.at(next, nullptr);
    if (!step || !(cost < fit.cost)) {
      damping = std::max(10 * damping, 1e-3);
      continue;
    }
    const bool is_done = fit.cost - cost < 1e-3 * fit.cost;
    fit.state = next, fit.cost = cost;
    damping *= 0.2;
    if (is_done) break;
  }
  Equations equations;
  problem.at(fit.state, &equations);
  fit.sigmas = std::sqrt(problem.squares / std::max(problem.residuals, 1));
  fit.variance = equations.variances().value_or(Unknowns{});
  return fit;
}

}  // namespace handcast::pose::stereo
