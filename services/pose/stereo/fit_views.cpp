// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/fit_views.hpp"

#include <algorithm>
#include <cmath>

#include "services/pose/lift/anatomy.hpp"
#include "services/pose/lift/hand_steps.hpp"

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
  state.posture.turn = turned_by(state.posture.turn, {step[0], step[1], step[2]});
  state.posture.palm_m += glm::dvec2(step[kPlaceAt], step[kPlaceAt + 1]);
  state.depth_m += step[kPlaceAt + 2];
  for_each(kAnglesAt, [&](int at, int f, int k) { state.posture.angle[f][k] += step[at]; });
  state.posture.log_size += step[kSizeAt];
  for_each(kBonesAt, [&](int at, int f, int k) { state.log_bone[f][k] += step[at]; });
  return state;
}

Unknowns difference(const HandState& from, const HandState& to) {
  const glm::dvec3 by = turn_between(from.posture.turn, to.posture.turn);
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
constexpr double kMostCorrelation = 0.95, kFalls_rad = 0.3;

}  // namespace

Likeness likeness_of(const Views& views, const glm::dvec3& hand_m) {
  const glm::dmat4& second_from_first = views[1].view_from_first;
  const glm::dmat3 turn(second_from_first);
  const glm::dvec3 centre_m = -glm::transpose(turn) * glm::dvec3(second_from_first[3]);
  const double cosine = glm::dot(glm::normalize(hand_m), glm::normalize(hand_m - centre_m));
  const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double roll = std::atan2(turn[0][1] - turn[1][0], turn[0][0] + turn[1][1]);
  return {kMostCorrelation * std::exp(-angle / kFalls_rad), std::cos(roll), std::sin(roll)};
}

namespace {

struct Equations : calib::NormalEquations {
  double squares = 0;  ///< of the landmarks' residuals, in sigmas
  int residuals = 0;
};

constexpr double kHuber = 3;  ///< beyond so many standard deviations, residuals count linearly

/// The errors of handcast's network on the twin relative to its landmarks' sigmas, as read() has
/// them: root mean square per axis 0.35 to 0.5.
constexpr double kErrorPerSigma = 0.5;

Moves moves_of(const PosedHand& hand, int landmark) {
  const glm::dvec3 at_m = hand.place_m[msg::kJointOfLandmark[landmark]];
  const glm::dvec3 arm_m = at_m - hand.place_m[kPalm];
  Moves moves;
  moves.add_turn(arm_m);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 unit(0);
    unit[axis] = 1;
    moves.add(kPlaceAt + axis, unit);
  }
  const int finger = (landmark - 1) / 4, along = landmark > 0 ? (landmark - 1) % 4 : -1;
  moves.add_angles(hand, landmark, kAnglesAt + finger * kAngles);
  moves.add(kSizeAt, arm_m);
  for (int k = 0; k <= along; ++k) {
    const int joint = kFirstJoint[finger] + k;
    moves.add(kBonesAt + finger * kAngles + k,
              hand.place_m[joint] - hand.place_m[renderer::kJointParent[joint]]);
  }
  return moves;
}

/// What is seen and known of a hand.
struct Problem {
  const Skeleton& skeleton;
  const Views& views;
  const SeenInViews& seen;
  const HandPrior& prior;
  Likeness likeness;  ///< of the views of this hand

  Equations equations_at(const HandState& state) const {
    const PosedHand hand = posed(skeleton, state);
    Equations equations{calib::NormalEquations::zero(kUnknowns)};
    for (int i = 0; i < msg::kLandmarks; ++i) add_landmark(hand, i, equations);
    const Unknowns off = difference(prior.mean, state);
    for (int i = 0; i < kUnknowns; ++i)
      if (prior.variance[i] > 0) expect(i, off[i], std::sqrt(prior.variance[i]), equations);
    add_anatomy(state.posture.angle, kAnglesAt, equations);
    return equations;
  }

 private:
  /// The residual of a landmark in one view, in sigmas, and the derivatives of its place there.
  struct Sighted {
    glm::dvec2 miss;
    std::array<double, Moves::kMost> across, down;
  };

  void add_landmark(const PosedHand& hand, int i, Equations& equations) const {
    const Moves moves = moves_of(hand, i);
    std::array<Sighted, kViews> sighted;
    int count = 0;
    for (int v = 0; v < kViews; ++v)
      if (seen[v] && seen[v]->sigma_px[i] > 0)
        sighted[count++] = sight(hand.place_m[msg::kJointOfLandmark[i]], v, i, moves);
    if (count == 0) return;
    const auto squared_of_all = [&] {
      double squared = 0;
      for (int v = 0; v < count; ++v) squared += glm::dot(sighted[v].miss, sighted[v].miss);
      return squared;
    };
    equations.squares += kErrorPerSigma * kErrorPerSigma * squared_of_all();
    equations.residuals += 2 * count;
    if (count == kViews) whiten(sighted, moves.count);
    const double squared = squared_of_all();
    const double sigmas = std::sqrt(squared), most = kHuber * std::sqrt(count);
    const double trust = std::min(1.0, most / std::max(sigmas, 1e-9));
    const auto columns = std::span(moves.columns).first(moves.count);
    for (int v = 0; v < count; ++v) {
      equations.add(columns, sighted[v].across, sighted[v].miss.x, trust);
      equations.add(columns, sighted[v].down, sighted[v].miss.y, trust);
    }
    equations.cost += sigmas < most ? 0.5 * squared : most * (sigmas - 0.5 * most);
  }

  Sighted sight(const glm::dvec3& place_m, int v, int i, const Moves& moves) const {
    const View& view = views[v];
    glm::dvec3 at_m = view.in_view(place_m);
    at_m.z = std::max(at_m.z, View::kNearest_m);
    const double scale = 1 / (kErrorPerSigma * seen[v]->sigma_px[i]);
    Sighted sighted{scale * (seen[v]->px[i] - view.camera.project(at_m)), {}, {}};
    if (v == 1) sighted.miss = likeness.as_first(sighted.miss);
    const glm::dmat3x2 px_per_m =
        view.camera.jacobian_px_per_m(at_m) * glm::dmat3(view.view_from_first);
    for (int c = 0; c < moves.count; ++c) {
      glm::dvec2 moved = scale * (px_per_m * moves.by[c]);
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
  const Problem problem{skeleton, views, seen, prior,
                        likeness_of(views, {start.posture.palm_m, start.depth_m})};
  const auto equations_at = [&](const HandState& state) { return problem.equations_at(state); };
  HandFit fit{.state = start};
  const auto equations = fit_hand<Unknowns>(fit.state, steps, equations_at, most_step);
  fit.cost = equations.cost;
  fit.variance = variances_of<Unknowns>(equations);
  fit.sigmas = std::sqrt(equations.squares / std::max(equations.residuals, 1));
  return fit;
}

}  // namespace handcast::pose::stereo
