// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "config/sections/cascade.hpp"
#include "ipc/msg/rung.hpp"
#include "renderer/base/landmark_points.hpp"

/// @file
/// How far a hand is corrected. Each rung does what the one before it does, and more. The highest
/// is the default; the others show what each part of the method brings. See
/// `docs/method.md#ladder`.
///
/// | rung       | free numbers | how the hand is placed                                      |
/// |------------|--------------|-------------------------------------------------------------|
/// | hold       | 0            | the newest tracker sample                                   |
/// | predict    | 0            | extrapolated to the time of the photons                     |
/// | shift      | 2            | and translated towards the landmarks                        |
/// | similarity | 4            | and rotated and scaled                                      |
/// | fingers    | 14           | and each finger translated                                  |
/// | landmarks  | 42           | as the estimate says, or each landmark to its own position  |
/// | register   | 42 +         | and moved as the newest image shows (late_registration.hpp) |

namespace handcast::renderer {

using msg::kRungs;
using msg::Rung;

/// The rung that `choice` sets.
Rung rung_of(config::RungChoice choice);

/// `p`, moved towards `q` by the least-squares model of a rung: not at all for hold and predict; by
/// a translation; by a similarity; by a similarity and the mean displacement that remains for each
/// finger. On the rungs above: `q`.
LandmarkPoints on_rung(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q);

}  // namespace handcast::renderer
