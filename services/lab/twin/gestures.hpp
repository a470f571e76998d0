// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <numbers>

#include "services/lab/twin/choreography.hpp"

namespace handcast::twin {

// What the built-in motions are made of.

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

/// Counts from one to five with the palm to the camera, the thumb last, and closes the hand.
Posture count_fingers(double seconds);
/// The bent fingers strike one after the other while the hand goes up and down the keys.
Posture play_piano(double seconds);
/// Opens the hand, closes it about a thing as wide as a cup, lifts and turns it, and lets go.
Posture grasp_and_release(double seconds);
/// Calls somebody: the fingers of a hand that shows its palm bend three times.
Posture beckon(double seconds);
/// The fingers rise and fall in a wave, as if a coin rolled over them, while the hand circles.
Posture roll_coin(double seconds);

}  // namespace handcast::twin
