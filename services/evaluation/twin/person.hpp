// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/twin.hpp"
#include "renderer/hand/maker/hand_shape.hpp"
#include "services/evaluation/twin/recording.hpp"

namespace handcast::twin {

/// Somebody else than the model: every finger's length, the palm and the widths drawn from the seed
/// within the settings' spread.
renderer::HandShape draw_person(const config::TwinShape& settings, int seed);

/// The person of a recording: joint places and bone lengths are medians over its samples, widths
/// follow the palm's breadth and the seed.
renderer::HandShape fit_person(const Recording& recording, const config::TwinShape& settings,
                               int seed);

}  // namespace handcast::twin
