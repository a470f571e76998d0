// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "config/sections/cascade.hpp"
#include "ipc/msg/rung.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/base/similarity.hpp"

/// @file
/// The rungs of the ladder: a frame models no more than its scene needs. Each rung does what the
/// one before it does, and more. See `docs/method.md#ladder`.
///
/// | rung       | free numbers | how the hand is placed                                      |
/// |------------|--------------|-------------------------------------------------------------|
/// | hold       | 0            | the newest tracker sample                                   |
/// | predict    | 0            | extrapolated to the time of the photons                     |
/// | shift      | 2            | and translated towards the landmarks                        |
/// | similarity | 4            | and rotated and scaled                                      |
/// | fingers    | 14           | and each finger translated                                  |
/// | landmarks  | 42           | each landmark moved to its own position (deform.hpp)        |
/// | register   | 42 +         | and moved as the newest image shows (late_registration.hpp) |

namespace handcast::renderer {

using msg::kRungs;
using msg::Rung;

/// The rung that `choice` sets; landmarks if it is automatic.
Rung held_rung(config::RungChoice choice);
/// Free numbers of the rung's model of Q̂ - P.
int degrees_of_freedom(Rung rung);

/// The model of Q̂ - P on the rungs shift, similarity and fingers. In the unit of the points that it
/// was fitted to.
struct RungModel {
  Similarity whole;                    ///< of the whole hand
  std::array<glm::vec2, 5> fingers{};  ///< displacement added to each finger, thumb first

  /// The point `at`, moved as the given landmark is.
  glm::vec2 moved(int landmark, const glm::vec2& at) const;
  /// All landmarks `p`, moved.
  LandmarkPoints moved(const LandmarkPoints& p) const;
};

/// The least-squares model of a rung that maps `p` to `q`: a translation; a similarity; a
/// similarity and the mean displacement that remains for each finger. The identity for hold and
/// predict. The rungs above fingers are modelled like fingers.
RungModel fit_rung(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q);

/// Mean square distance over the landmarks between `p`, moved by the model, and `q`, px^2.
float residual_px2(const RungModel& model, const LandmarkPoints& p, const LandmarkPoints& q);

}  // namespace handcast::renderer
