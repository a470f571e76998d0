// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/twin.hpp"
#include "renderer/hand/maker/hand_shape.hpp"
#include "services/evaluation/twin/recording.hpp"

namespace handcast::twin {

/// Draws the hand shape of a person: the length of each finger, the size of the palm and the widths
/// differ from the mean hand by at most the spread of the settings.
renderer::HandShape draw_person(const config::TwinShape& settings, int seed);

/// Fits the hand shape of the person in a recording (the left hand if recorded): joint positions
/// and bone lengths are medians over the samples; the widths follow the palm's breadth and the
/// seed.
renderer::HandShape fit_person(const Recording& recording, const config::TwinShape& settings,
                               int seed);

}  // namespace handcast::twin
