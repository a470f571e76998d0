// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

#include "services/lab/twin/choreography.hpp"

/// What the built-in motions are made of.
namespace handcast::twin {

inline constexpr double kTurn = 2 * std::numbers::pi;

/// A sine; `phase` in turns.
double wave_at(double hz, double t, double phase = 0);
/// Rises from 0 to 1 and falls back to 0 in each period, starting at 0.
double pulse_at(double hz, double t);
/// From 0 to 1 between two times along the minimum-jerk curve of reaching movements (Flash and
/// Hogan 1985).
double step_at(double begin_s, double end_s, double t);
/// The time since the current period began.
double within(double period_s, double t);

/// Adds the slow sway of a hand that is held in the air.
void breathe(Posture& posture, double t);
/// Bends a finger: 0 straight, 1 in the palm.
void curl(Bend& bend, int finger, double amount);
/// Lays the thumb over the fingers: 0 open, 1 shut.
void close_thumb(Bend& bend, double shut);

}  // namespace handcast::twin
