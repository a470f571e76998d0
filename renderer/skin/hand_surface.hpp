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

/// The skinned surface of one hand in one frame, per vertex of its mesh. Borrowed from a
/// HandSurface until its next pose().
struct Skinned {
  std::span<const glm::vec2> seen_px;  ///< projector px, in the pose that was skinned
  std::span<glm::vec2> projected_px;   ///< the same; to be moved by the step "correct"
  std::span<const float> depth_m;      ///< distance along the camera's axis
  std::span<const float> distance_m;   ///< distance along the projector's axis
  std::span<float> light;              ///< factor of the levels, 0..1; empty: 1 everywhere
  /// In camera space; `normal` has unit length, and is empty unless it was asked for.
  /// @{
  std::span<const glm::vec3> position_m, normal;
  /// @}
  /// Sign of the area (projector px, y down) of a triangle that faces the camera.
  float facing_sign = -1;
};

/// Step "skin" and its state: the mesh of one hand without the forearm, the proportions of the
/// person, and the buffers of a frame. See `docs/method.md#skin`. One thread.
class HandSurface {
 public:
  /// Takes the mesh. Triangles more than `forearm_mm` from the wrist towards the elbow are not
  /// drawn.
  HandSurface(HandMesh mesh, double forearm_mm);

  /// Adds a tracker sample, from which the proportions of the person are learned.
  void learn(std::int64_t origin_ns, const msg::HandPose& pose) {
    bone_fit_.learn(origin_ns, frames_of(pose));
  }

  /// Skins the mesh and projects it through the camera to the projector. `shading`: share of
  /// Lambert's law in the light, 0..1, of a light that shines along the camera's axis. `presence`:
  /// factor of all levels, 0..1, so that a fade looks even. `is_shared`: normals are needed, and
  /// the light is not empty.
  Skinned pose(const msg::HandPose& pose, const config::Skin& settings,
               const calib::Calibration& calibration, float shading, float presence = 1,
               bool is_shared = false);

  /// Learns the widths of the fingers from the projected vertices of the last pose(), after
  /// correction, and the landmarks and the mask at the same time, `time_ns`. All in projector px.
  void learn_widths(std::int64_t time_ns, const LandmarkPoints& landmarks_px, GreyView mask);

  /// The mesh without the forearm. All vertices are kept.
  const HandMesh& mesh() const { return mesh_; }
  /// Bounds of the vertices of the drawn triangles, in whole pixels.
  Rect bounds(std::span<const glm::vec2> position_px) const;

 private:
  HandMesh mesh_;
  BoneFit bone_fit_;
  WidthMeter width_meter_;
  std::vector<std::uint16_t> drawn_vertices_;
  std::vector<glm::vec3> positions_m_, normals_;
  std::vector<glm::vec2> seen_px_, landings_px_;
  std::vector<float> depth_m_, distance_m_, light_;
};

}  // namespace handcast::renderer
