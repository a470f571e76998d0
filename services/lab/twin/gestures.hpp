// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "services/lab/twin/choreography.hpp"

/// Built-in motions that no setting of the cascade was chosen on, and that nobody may choose one
/// on: config/sweeps/unseen.toml scores the cascades on them.
namespace handcast::twin {

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
