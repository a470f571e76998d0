// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/gestures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace handcast::twin {

double wave_at(double hz, double t, double phase) { return std::sin(kTurn * (hz * t + phase)); }

double pulse_at(double hz, double t) { return 0.5 - 0.5 * std::cos(kTurn * hz * t); }

double step_at(double begin_s, double end_s, double t) {
  const double x = std::clamp((t - begin_s) / (end_s - begin_s), 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}

double within(double period_s, double t) { return t - period_s * std::floor(t / period_s); }

void breathe(Posture& posture, double t) {
  posture.shift += glm::dvec3(0.008 * wave_at(0.23, t), 0.006 * wave_at(0.31, t, 0.2),
                              0.006 * wave_at(0.17, t, 0.4));
  posture.sway += 0.03 * wave_at(0.19, t, 0.1);
  posture.nod += 0.04 * wave_at(0.27, t, 0.3);
}

void curl(Bend& bend, int finger, double amount) {
  bend.flexion[finger] = {1.25 * amount, 1.65 * amount, 0.95 * amount};
}

void close_thumb(Bend& bend, double shut) {
  bend.flexion[0] = {0.6 * shut, 0.9 * shut, 0};
  bend.thumb_flexion = 0.25 * shut;
  bend.thumb_opposition = -0.2 * shut;
}

Posture count_fingers(double t) {
  Posture posture;
  constexpr double kRound_s = 5.2, kEach_s = 0.85, kRaise_s = 0.3, kShut_s = 4.7;
  constexpr std::array<double, 5> kTurnOf{4, 0, 1, 2, 3};  // index finger first, thumb last
  const double round = within(kRound_s, t);
  const auto begin_s = [&](int finger) {
    return 0.1 + kEach_s * kTurnOf[static_cast<std::size_t>(finger)];
  };
  const auto raised = [&](int finger) {
    return step_at(begin_s(finger), begin_s(finger) + kRaise_s, round) -
           step_at(kShut_s, kRound_s - 0.1, round);
  };
  for (int f = 1; f < 5; ++f) {
    // A finger takes its neighbour with it a little.
    const double taken = f > 1 ? 0.15 * raised(f - 1) * (1 - raised(f)) : 0;
    curl(posture.bend, f, 0.95 - 0.9 * raised(f) - taken);
    posture.bend.splay[static_cast<std::size_t>(f)] = (2.4 - f) * 0.08 * raised(f);
  }
  close_thumb(posture.bend, 0.9 * (1 - raised(0)));
  posture.turn = 0.88 * kTurn / 2;
  for (int f = 0; f < 5; ++f)  // a beat with each number
    posture.nod -= 0.12 * (step_at(begin_s(f), begin_s(f) + 0.2, round) -
                           step_at(begin_s(f) + 0.2, begin_s(f) + 0.6, round));
  breathe(posture, t);
  return posture;
}

Posture play_piano(double t) {
  Posture posture;
  constexpr double kNote_s = 0.2;
  constexpr std::array<int, 8> kNotes{0, 1, 2, 3, 4, 3, 2, 1};
  constexpr double kBar_s = 8 * kNote_s;
  std::array<double, 5> struck{};
  for (std::size_t n = 0; n < kNotes.size(); ++n) {
    // From 0.1 s before the note to 0.12 s after it.
    const double since_s = within(kBar_s, t - kNote_s * static_cast<double>(n) + 0.1);
    struck[static_cast<std::size_t>(kNotes[n])] +=
        step_at(0, 0.1, since_s) - step_at(0.1, 0.22, since_s);
  }
  for (std::size_t f = 1; f < 5; ++f) {
    posture.bend.flexion[f] = {0.35 + 0.4 * struck[f], 0.6 + 0.12 * struck[f], 0.3};
    posture.bend.splay[f] = (2.4 - static_cast<double>(f)) * 0.06;
  }
  posture.bend.flexion[0] = {0.15 + 0.2 * struck[0], 0.2 + 0.25 * struck[0], 0};
  posture.bend.thumb_flexion = 0.15 * struck[0];
  posture.shift.x = 0.035 * wave_at(0.5 / kBar_s, t);
  posture.turn = 0.12 * wave_at(1 / kBar_s, t, 0.1);
  posture.nod = 0.3 + 0.05 * wave_at(0.5 / kNote_s, t);
  breathe(posture, t);
  return posture;
}

Posture grasp_and_release(double t) {
  Posture posture;
  const double round = within(3.6, t);
  const double opened = step_at(0.1, 0.6, round) - step_at(0.7, 1.1, round) +
                        step_at(2.7, 3.0, round) - step_at(3.1, 3.6, round);
  const double closed = step_at(0.7, 1.15, round) - step_at(2.6, 3.0, round);
  const double lifted = step_at(1.2, 1.8, round) - step_at(2.0, 2.6, round);
  for (std::size_t f = 1; f < 5; ++f) {
    const double later = 1 - 0.04 * static_cast<double>(f);
    posture.bend.flexion[f] = {0.2 - 0.15 * opened + 0.5 * closed,
                               0.35 - 0.25 * opened + 0.35 * closed * later,
                               0.2 - 0.12 * opened + 0.2 * closed * later};
    posture.bend.splay[f] = (2.4 - static_cast<double>(f)) * (0.03 + 0.07 * opened);
  }
  posture.bend.flexion[0] = {0.15 + 0.15 * closed, 0.2 - 0.1 * opened + 0.25 * closed, 0};
  posture.bend.thumb_opposition = 0.12 * closed - 0.1 * opened;
  posture.bend.thumb_flexion = 0.15 * closed;
  posture.turn = 0.9 + 0.5 * lifted;
  posture.nod = 0.1 - 0.2 * lifted;
  posture.shift = {0.015 * lifted, -0.035 * lifted, -0.03 * closed};
  breathe(posture, t);
  return posture;
}

Posture beckon(double t) {
  Posture posture;
  const double round = within(3, t);
  const double calls = (step_at(0.2, 0.5, round) - step_at(1.9, 2.2, round));
  for (int f = 1; f < 5; ++f) {
    curl(posture.bend, f, 0.12 + 0.75 * calls * pulse_at(1.6, round - 0.2 - 0.025 * (4 - f)));
    posture.bend.splay[static_cast<std::size_t>(f)] = (2.4 - f) * 0.03;
  }
  posture.bend.flexion[0] = {0.2, 0.25, 0};
  posture.bend.thumb_opposition = 0.05;
  posture.turn = 0.92 * kTurn / 2;
  posture.nod = -0.25 * calls * pulse_at(1.6, round - 0.15);
  breathe(posture, t);
  return posture;
}

Posture roll_coin(double t) {
  Posture posture;
  constexpr double kHz = 0.7;
  for (std::size_t f = 1; f < 5; ++f) {
    const double behind = -0.16 * static_cast<double>(f);
    posture.bend.flexion[f] = {0.5 + 0.35 * wave_at(kHz, t, behind),
                               0.65 + 0.35 * wave_at(kHz, t, behind - 0.1),
                               0.35 + 0.15 * wave_at(kHz, t, behind - 0.1)};
  }
  posture.bend.flexion[0] = {0.2 + 0.15 * wave_at(kHz, t, 0.2), 0.3 + 0.2 * wave_at(kHz, t, 0.3),
                             0};
  posture.bend.thumb_opposition = 0.1 * wave_at(kHz, t, 0.05);
  posture.bend.thumb_flexion = 0.1 + 0.1 * wave_at(kHz, t, 0.3);
  posture.shift = {0.02 * wave_at(0.4, t), 0.015 * wave_at(0.4, t, 0.25), 0};
  posture.turn = 0.35 * wave_at(0.29, t);
  posture.sway = 0.06 * wave_at(0.4, t, 0.1);
  breathe(posture, t);
  return posture;
}

}  // namespace handcast::twin
