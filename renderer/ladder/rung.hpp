// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "config/sections/cascade.hpp"
#include "ipc/msg/rung.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/base/similarity.hpp"

/// The ladder (METHOD section 3): model no more than a scene needs. Each rung does what the one
/// before it does, and more.
///
/// | rung       | numbers | what moves the tracker's hand                            |
/// |------------|---------|----------------------------------------------------------|
/// | hold       | 0       | nothing: the newest sample as it is                      |
/// | predict    | 0       | its own motion, on to the time of the light              |
/// | shift      | 2       | and one shift towards the landmarks                      |
/// | similarity | 4       | and one turn and scale                                   |
/// | fingers    | 14      | and a shift of each finger                               |
/// | landmarks  | 42      | each landmark onto its own place (deform.hpp)            |
/// | register   | 42 +    | and what the newest image shows of its motion since      |
/// |            |         | (late_registration.hpp)                                  |
namespace handcast::renderer {

using msg::kRungs;
using msg::Rung;

/// The rung that a setting holds; landmarks if it holds none.
Rung held_rung(config::RungChoice choice);
/// Free numbers of the field that carries P onto Q.
int degrees_of_freedom(Rung rung);

/// The field of the rungs shift, similarity and fingers.
struct RungModel {
  Similarity whole;
  std::array<glm::vec2, 5> fingers{};  ///< on top of it, thumb first

  glm::vec2 moved(int landmark, const glm::vec2& at) const;
  LandmarkPoints moved(const LandmarkPoints& p) const;
};

/// Least squares from `p` to `q`: a shift, a similarity, a similarity and what each finger's
/// landmarks are then off by in the mean. The identity for hold and predict; dearer rungs are
/// modelled as fingers.
RungModel fit_rung(Rung rung, const LandmarkPoints& p, const LandmarkPoints& q);

/// Mean square over the landmarks of what the model leaves, px^2.
float residual_px2(const RungModel& model, const LandmarkPoints& p, const LandmarkPoints& q);

}  // namespace handcast::renderer
