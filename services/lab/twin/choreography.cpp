// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/choreography.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "services/lab/twin/gestures.hpp"

namespace handcast::twin {
namespace {

Posture open_close(double t) {
  Posture posture;
  for (int f = 1; f < 5; ++f) {
    curl(posture.bend, f, pulse_at(0.45, t - 0.05 * (f - 1)));
    posture.bend.splay[f] = (2.4 - f) * 0.07 * (1 - pulse_at(0.45, t));
  }
  close_thumb(posture.bend, pulse_at(0.45, t - 0.12));
  breathe(posture, t);
  return posture;
}

Posture wave(double t) {
  Posture posture;
  posture.sway = 0.2 * wave_at(0.8, t);
  posture.turn = 0.25 * wave_at(0.8, t, -0.1);
  for (int f = 1; f < 5; ++f)
    posture.bend.flexion[f] = {0.12 + 0.1 * wave_at(0.8, t, -0.2),
                               0.1 + 0.08 * wave_at(0.8, t, -0.25), 0.05};
  breathe(posture, t);
  return posture;
}

Posture rotate(double t) {
  Posture posture;
  posture.turn = std::numbers::pi * pulse_at(0.125, t);
  for (int f = 1; f < 5; ++f) posture.bend.flexion[f][0] = 0.1 * pulse_at(0.3, t - 0.2 * f);
  breathe(posture, t);
  return posture;
}

/// At an amount of 1, the tips of the thumb and the index finger of the mean hand meet.
Posture pinch(double t) {
  Posture posture;
  const double amount = pulse_at(0.6, t);
  posture.bend.flexion[1] = {0.75 * amount, 0.80 * amount, 0.35 * amount};
  posture.bend.flexion[0] = {0.25 * amount, 0.35 * amount, 0};
  posture.bend.thumb_opposition = 0.1 * amount;
  posture.bend.thumb_flexion = 0.2 * amount;
  for (int f = 2; f < 5; ++f) curl(posture.bend, f, 0.12 + 0.08 * pulse_at(0.6, t - 0.1 * f));
  breathe(posture, t);
  return posture;
}

/// Bursts of shaking: the peak speed of the palm rises from 0.3 to 1.3 m/s and falls again every 4
/// s.
Posture shake(double t) {
  Posture posture;
  const double burst = 0.25 + 0.75 * pulse_at(0.25, t);
  posture.shift = burst * glm::dvec3(0.052 * wave_at(3.2, t), 0.012 * wave_at(2.3, t),
                                     0.01 * wave_at(1.7, t, 0.3));
  posture.sway = 0.05 * burst * wave_at(3.2, t, -0.08);
  for (int f = 1; f < 5; ++f)
    posture.bend.flexion[f] = {0.1 + 0.08 * burst * wave_at(3.2, t, -0.15), 0.15, 0.08};
  breathe(posture, t);
  return posture;
}

Posture two_hands(double t) {
  Posture posture;
  posture.shift = {0.022 * wave_at(0.5, t), 0.03 * wave_at(0.37, t), 0.02 * wave_at(0.21, t)};
  posture.sway = 0.06 * wave_at(0.5, t, -0.1);
  posture.turn = 0.2 * wave_at(0.29, t);
  for (int f = 1; f < 5; ++f) curl(posture.bend, f, 0.55 * pulse_at(0.4, t - 0.06 * f));
  posture.bend.flexion[0] = {0.3 * pulse_at(0.4, t), 0.4 * pulse_at(0.4, t), 0};
  return posture;
}

/// Physiological tremor: 0.1 mm at about 8 Hz.
Posture still(double t) {
  Posture posture;
  posture.shift = 0.0001 * glm::dvec3(wave_at(8.0, t), wave_at(7.3, t, 0.3), wave_at(8.6, t, 0.6));
  return posture;
}

/// Two hands pass in front of each other, swap places and return.
Posture crossing(double t) {
  Posture posture;
  posture.over = pulse_at(0.4, t);
  posture.shift = {0.004 * wave_at(0.5, t), 0.006 * wave_at(0.37, t), 0};
  for (int f = 1; f < 5; ++f) curl(posture.bend, f, 0.12 + 0.08 * wave_at(0.45, t, 0.1 * f));
  return posture;
}

/// Turns the hand over in 0.4 s, and back.
Posture flip(double t) {
  Posture posture;
  const double round = within(2, t);
  posture.turn = std::numbers::pi * (step_at(0.5, 0.9, round) - step_at(1.4, 1.8, round));
  for (int f = 1; f < 5; ++f) posture.bend.flexion[f] = {0.08, 0.1, 0.05};
  breathe(posture, t);
  return posture;
}

/// Closes the hand in 0.25 s, holds it and opens it in 0.3 s.
Posture fist(double t) {
  Posture posture;
  const auto shut_at = [&](double later_s) {
    const double round = within(2, t - later_s);
    return step_at(0.4, 0.65, round) - step_at(1.3, 1.6, round);
  };
  for (int f = 1; f < 5; ++f) {
    curl(posture.bend, f, 1.05 * shut_at(0.012 * (f - 1)));
    posture.bend.splay[f] = (2.4 - f) * 0.07 * (1 - shut_at(0));
  }
  close_thumb(posture.bend, shut_at(0.08));
  breathe(posture, t);
  return posture;
}

/// The palm faces the camera; the fingers bend at the MCPs until they point into the lens.
Posture point_at_camera(double t) {
  Posture posture;
  const double round = within(2.4, t);
  const double pointing = step_at(0.4, 0.9, round) - step_at(1.5, 2, round);
  posture.turn = std::numbers::pi;
  for (int f = 1; f < 5; ++f) {
    posture.bend.flexion[f] = {1.4 * pointing, 0.06 * pointing, 0.04};
    posture.bend.splay[f] = (2.4 - f) * 0.07 * (1 - pointing);
  }
  breathe(posture, t);
  return posture;
}

/// Moves the middle finger across the back of the index finger and beyond.
Posture cross_fingers(double t) {
  Posture posture;
  const double round = within(2.4, t);
  const double crossed = step_at(0.4, 0.8, round) - step_at(1.5, 1.9, round);
  // The fingers separate in depth before they cross; on the way back the order is reversed.
  const double apart = step_at(0.3, 0.6, round) - step_at(1.7, 2.1, round);
  posture.bend.flexion[1] = {0.08 + 0.5 * apart, 0.1, 0.05};
  posture.bend.flexion[2] = {0.08 - 0.1 * apart, 0.1, 0.05};
  posture.bend.flexion[3] = posture.bend.flexion[4] = {0.15, 0.2, 0.1};
  posture.bend.splay[1] = 0.08 - 0.36 * crossed;
  posture.bend.splay[2] = 0.3 * crossed;
  breathe(posture, t);
  return posture;
}

/// The hand leaves the image at the bottom, is absent for 0.6 s and returns.
Posture enter_leave(double t) {
  Posture posture;
  const double round = within(3, t);
  const double out = step_at(1, 1.5, round) - step_at(2.1, 2.6, round);
  posture.shift.y = 0.31 * out;
  posture.gone = round > 1.5 && round < 2.1;
  for (int f = 1; f < 5; ++f) posture.bend.flexion[f] = {0.1, 0.12, 0.06};
  breathe(posture, t);
  return posture;
}

/// Moves to and fro at a nearly constant speed with abrupt reversals. The speed rises to 2 m/s and
/// falls again every 4 s.
Posture reverse(double t) {
  Posture posture;
  constexpr double kHz = 3.6, kSharpness = 0.9;  // sharpness 0: a sine; 1: a triangle wave
  const auto zigzag = [&](double phase) {
    return std::asin(kSharpness * wave_at(kHz, t, phase)) / std::asin(kSharpness);
  };
  const double burst = 0.3 + 0.7 * pulse_at(0.25, t);
  posture.shift = burst * glm::dvec3(0.1 * zigzag(0), 0.012 * wave_at(2.3, t), 0);
  posture.sway = 0.03 * burst * wave_at(kHz, t, -0.08);
  for (int f = 1; f < 5; ++f)
    posture.bend.flexion[f] = {0.1 + 0.05 * burst * wave_at(kHz, t, -0.15), 0.15, 0.08};
  breathe(posture, t);
  return posture;
}

/// Four seconds for a demonstration: waves (up to 1.3 m/s), turns, folds, pinches and turns back.
Posture show(double t) {
  Posture posture;
  const double round = within(4, t);
  const auto during = [&](double begin_s, double rise_s, double end_s, double fall_s) {
    return step_at(begin_s, begin_s + rise_s, round) - step_at(end_s - fall_s, end_s, round);
  };
  const double waving = during(0.2, 0.4, 1.5, 0.4), turned = during(1.5, 0.6, 3.9, 0.5),
               folded = during(2.1, 0.3, 2.75, 0.25), pinched = during(2.75, 0.3, 3.4, 0.25);
  posture.sway = 0.3 * waving * wave_at(1.6, round - 0.2);
  posture.turn = 0.2 * waving * wave_at(1.6, round - 0.2, -0.1) + std::numbers::pi * turned;
  for (int f = 1; f < 5; ++f) {
    curl(posture.bend, f, folded + (f > 1 ? 0.15 * pinched : 0));
    posture.bend.flexion[f][0] += 0.1 + 0.1 * waving * wave_at(1.6, round - 0.2, -0.2);
    posture.bend.splay[f] = (2.4 - f) * 0.07 * (1 - folded);
  }
  posture.bend.flexion[1][0] += 0.75 * pinched;
  posture.bend.flexion[1][1] += 0.80 * pinched;
  posture.bend.flexion[1][2] += 0.35 * pinched;
  close_thumb(posture.bend, folded);
  posture.bend.flexion[0][0] += 0.25 * pinched;
  posture.bend.flexion[0][1] += 0.35 * pinched;
  posture.bend.thumb_opposition += 0.1 * pinched;
  posture.bend.thumb_flexion += 0.2 * pinched;
  breathe(posture, t);
  return posture;
}

/// A hand that points up with its index finger turns about the finger, so that it is seen from its
/// back, its edges and its palm.
Posture turn_pointing(double t) {
  Posture posture;
  for (int f = 2; f < 5; ++f) curl(posture.bend, f, 0.95);
  posture.bend.flexion[1] = {0.1, 0.12, 0.08};
  close_thumb(posture.bend, 0.8);
  posture.turn = kTurn / 2 * pulse_at(0.14, t) + 0.3 * wave_at(0.31, t);
  breathe(posture, t);
  return posture;
}

/// A fist is shown from four sides, for a second each.
Posture turn_fist(double t) {
  Posture posture;
  for (int f = 1; f < 5; ++f) curl(posture.bend, f, 1);
  close_thumb(posture.bend, 1);
  const double round = within(9, t);
  const double quarters = step_at(1, 1.5, round) + step_at(2.5, 3, round) + step_at(4, 4.5, round) -
                          3 * step_at(5.5, 7, round);
  posture.turn = kTurn / 4 * quarters;
  breathe(posture, t);
  return posture;
}

/// The hand of a person who calibrates or tries a rig: it goes from place to place, and is held for
/// a moment at each, turned and bent differently.
Posture places(double t) {
  constexpr double kEach_s = 1.8, kWay_s = 0.7;
  const auto pose_of = [](double place) {
    // Steps by irrational shares of the range never repeat a place.
    const auto share = [place](double step) {
      return 2 * (place * step - std::floor(place * step)) - 1;
    };
    Posture posture;
    posture.shift = {0.045 * share(0.6180), 0.04 * share(0.7549), 0.07 * share(0.5698)};
    posture.sway = 0.5 * share(0.8192);
    constexpr double kForearm_m = 0.25;  // the sway turns about the elbow, and here about the wrist
    posture.shift.x -= kForearm_m * std::sin(posture.sway);
    posture.shift.y -= kForearm_m * (1 - std::cos(posture.sway));
    posture.turn = 0.8 * share(0.6710) + (share(0.4142) > 0.4 ? std::numbers::pi : 0);
    posture.nod = 0.35 * share(0.5497);
    for (int f = 1; f < 5; ++f) curl(posture.bend, f, 0.25 * (1 + share(0.3247 + 0.1 * f)));
    return posture;
  };
  const double place = std::floor(t / kEach_s);
  const double way = step_at(0, kWay_s, within(kEach_s, t));
  const Posture from = pose_of(place), to = pose_of(place + 1);
  Posture posture;
  posture.shift = glm::mix(from.shift, to.shift, way);
  posture.sway = std::lerp(from.sway, to.sway, way);
  posture.turn = std::lerp(from.turn, to.turn, way);
  posture.nod = std::lerp(from.nod, to.nod, way);
  for (int f = 1; f < 5; ++f)
    for (int bone = 0; bone < 3; ++bone)
      posture.bend.flexion[f][bone] =
          std::lerp(from.bend.flexion[f][bone], to.bend.flexion[f][bone], way);
  posture.shift += 0.0005 * glm::dvec3(wave_at(1.1, t), wave_at(0.9, t, 0.3), wave_at(0.7, t, 0.6));
  return posture;
}

constexpr std::array<Choreography, 23> kChoreographies{{
    {"show", show},
    {"open_close", open_close},
    {"wave", wave},
    {"rotate", rotate},
    {"pinch", pinch},
    {"shake", shake},
    {"two_hands", two_hands, true, 1.3},
    {"still", still},
    {"crossing", crossing, true},
    {"flip", flip},
    {"fist", fist},
    {"point_at_camera", point_at_camera},
    {"enter_leave", enter_leave},
    {"reverse", reverse},
    {"cross_fingers", cross_fingers},
    {"turn_pointing", turn_pointing},
    {"turn_fist", turn_fist},
    {"places", places},
    {"count", count_fingers},
    {"piano", play_piano},
    {"grasp", grasp_and_release},
    {"beckon", beckon},
    {"coin", roll_coin},
}};

}  // namespace

std::span<const Choreography> choreographies() { return kChoreographies; }

}  // namespace handcast::twin
