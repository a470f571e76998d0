// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bitset>

#include "services/pose/lift/skeleton.hpp"
#include "services/pose/stereo/view.hpp"

namespace handcast::pose::stereo {

/// Landmarks of a hand that a view cannot see, because the other hand is before them.
using Hidden = std::bitset<msg::kLandmarks>;

/// The landmarks of `hand` that `other` hides from a view: they are behind one of its bones, with
/// the flesh around it. Both in the space of the first camera. A detector takes the hand in front
/// for the one behind it there, and is sure of it.
Hidden hidden_by(const PosedHand& other, const PosedHand& hand, const View& view);

}  // namespace handcast::pose::stereo
