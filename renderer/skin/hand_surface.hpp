// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "calib/calibration.hpp"
#include "config/sections/cascade.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/skin/bone_fit.hpp"
#include "renderer/skin/width_meter.hpp"

namespace handcast::renderer {

/// One hand's skin in one frame, per vertex of its mesh. Borrowed from a HandSurface until its next
/// pose().
struct Skinned {
  std::span<const glm::vec2> seen_px;  ///< projector px, as the tracker has it
  std::span<glm::vec2> landings_px;    ///< the same, to be moved by the correction
  std::span<const float> depth_m;      ///< distance along the camera's axis
  std::span<const float> light;        ///< factor 0..1; empty: 1 everywhere
  float facing_sign = -1;  ///< sign of the projected area of a triangle that faces the camera
};

/// Step "skin" of the cascade and its state: the mesh of one hand without what lies beyond the
/// wrist's cut, what is known of the person, and the buffers of a frame. One thread.
class HandSurface {
 public:
  HandSurface(HandMesh mesh, double forearm_mm);

  /// A tracker sample, from which the person's proportions are learned.
  void learn(std::int64_t origin_ns, const msg::HandPose& pose) {
    bone_fit_.learn(origin_ns, frames_of(pose));
  }

  /// Skins the mesh and projects it through the camera onto the projector. `shading` 0..1; light
  /// comes from the camera's side. All light is multiplied by `presence` 0..1.
  Skinned pose(const msg::HandPose& pose, const config::Skin& settings,
               const calib::Calibration& calibration, float shading, float presence = 1);

  /// Learns the person's widths from the mask of this hand (projector px) at the time that the
  /// landings of the last pose() are for.
  void learn_widths(std::int64_t time_ns, const LandmarkPoints& landmarks_px, GreyView mask);

  const HandMesh& mesh() const { return mesh_; }
  /// Bounds of the drawn triangles' vertices, whole pixels.
  Rect bounds(std::span<const glm::vec2> position_px) const;

 private:
  HandMesh mesh_;
  BoneFit bone_fit_;
  WidthMeter width_meter_;
  std::vector<std::uint16_t> drawn_vertices_;
  std::vector<glm::vec3> positions_m_, normals_;
  std::vector<glm::vec2> seen_px_, landings_px_;
  std::vector<float> depth_m_, light_;
};

}  // namespace handcast::renderer
