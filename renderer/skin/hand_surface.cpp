// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/hand_surface.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/base/clones.hpp"
#include "renderer/base/srgb.hpp"
#include "renderer/skin/skinning.hpp"

namespace handcast::renderer {
namespace {

constexpr int kWristBone = 1;
constexpr float kNearestVertex_m =
    0.02f;  ///< vertices nearer to the camera's plane are moved to here

/// Removes the triangles whose corners are mostly moved by the wrist and lie more than `forearm_mm`
/// from it towards the elbow.
HandMesh without_forearm(HandMesh mesh, double forearm_mm) {
  const glm::mat4 wrist_from_model = glm::inverse(mesh.rest[kWristBone]);
  std::vector<bool> beyond(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    float on_wrist = 0;
    for (int k = 0; k < 4; ++k)
      if (mesh.joints[v][k] == kWristBone) on_wrist += mesh.weights[v][k];
    const float towards_elbow_m = (wrist_from_model * glm::vec4(mesh.positions[v], 1)).z;
    beyond[v] = on_wrist > 0.5f && towards_elbow_m * 1e3f > static_cast<float>(forearm_mm);
  }
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    return beyond[triangle[0]] && beyond[triangle[1]] && beyond[triangle[2]];
  });
  return mesh;
}

std::vector<std::uint16_t> vertices_of(const HandMesh& mesh) {
  std::vector<bool> used(mesh.vertex_count());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint16_t v : triangle) used[v] = true;
  std::vector<std::uint16_t> vertices;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) vertices.push_back(static_cast<std::uint16_t>(v));
  return vertices;
}

/// `position`: xyz xyz ...; `m`: column-major, 3 rows and 4 columns, from camera space to
/// homogeneous projector px, whose third row is the distance along the projector's axis; `px`: xy
/// xy ...
HANDCAST_CLONES void project_all(const float* position, int count, const float* m, float nearest,
                                 float* px, float* depth, float* distance) {
  for (int v = 0; v < count; ++v) {
    const float x = position[3 * v], y = position[3 * v + 1],
                z = position[3 * v + 2] < nearest ? nearest : position[3 * v + 2];
    const float away = m[2] * x + m[5] * y + m[8] * z + m[11], scale = 1.0f / away;
    px[2 * v] = (m[0] * x + m[3] * y + m[6] * z + m[9]) * scale;
    px[2 * v + 1] = (m[1] * x + m[4] * y + m[7] * z + m[10]) * scale;
    depth[v] = z;
    distance[v] = away;
  }
}

/// Lambert's law for light along the camera's axis. The camera's z points forwards, so the normal
/// of a surface that faces the camera has z = -1.
HANDCAST_CLONES void shade_all(const float* normal, int count, float shading, float presence,
                               float* light) {
  for (int v = 0; v < count; ++v) {
    const float lambert = normal[3 * v + 2] < 0 ? -normal[3 * v + 2] : 0.0f;
    light[v] = presence * fast_srgb_level(1 - shading + shading * lambert);
  }
}

}  // namespace

HandSurface::HandSurface(HandMesh mesh, double forearm_mm)
    : mesh_(without_forearm(std::move(mesh), forearm_mm)),
      bone_fit_(mesh_),
      width_meter_(mesh_),
      drawn_vertices_(vertices_of(mesh_)),
      positions_m_(mesh_.vertex_count()),
      normals_(mesh_.vertex_count()),
      seen_px_(mesh_.vertex_count()),
      landings_px_(mesh_.vertex_count()),
      depth_m_(mesh_.vertex_count()),
      distance_m_(mesh_.vertex_count()),
      light_(mesh_.vertex_count()) {}

Skinned HandSurface::pose(const msg::HandPose& pose, const config::Skin& settings,
                          const calib::Calibration& calibration, float shading, float presence,
                          bool is_shared) {
  JointFrames frames = settings.fit ? bone_fit_(frames_of(pose)) : frames_of(pose);
  const glm::mat4 camera_from_tracker(calibration.camera_from_tracker);
  for (glm::mat4& frame : frames) frame = camera_from_tracker * frame;
  const bool shaded = shading > 0;
  const bool lit_fully = !shaded && presence >= 1 && !is_shared;
  const auto normals = shaded || is_shared ? std::span(normals_) : std::span<glm::vec3>();
  skin(mesh_, frames, positions_m_, normals);

  const glm::mat4x3 projector_from_space(calibration.projection());
  const int count = static_cast<int>(mesh_.vertex_count());
  project_all(&positions_m_[0].x, count, &projector_from_space[0][0], kNearestVertex_m,
              &seen_px_[0].x, depth_m_.data(), distance_m_.data());
  if (shaded) shade_all(&normals_[0].x, count, shading, presence, light_.data());
  if (!shaded) std::fill(light_.begin(), light_.end(), presence);
  std::copy(seen_px_.begin(), seen_px_.end(), landings_px_.begin());
  return {seen_px_,
          landings_px_,
          depth_m_,
          distance_m_,
          lit_fully ? std::span<float>() : light_,
          positions_m_,
          normals,
          glm::determinant(calibration.projector.from_camera * calibration.camera.matrix()) > 0
              ? -1.0f
              : 1.0f};
}

void HandSurface::learn_widths(std::int64_t time_ns, const LandmarkPoints& landmarks_px,
                               GreyView mask) {
  width_meter_.measure(time_ns, landings_px_, landmarks_px, mask);
  bone_fit_.widen(width_meter_.factor());
}

Rect HandSurface::bounds(std::span<const glm::vec2> position_px) const {
  constexpr float kFar_px = 1e6f;
  glm::vec2 low{kFar_px}, high{-kFar_px};
  for (const std::uint16_t v : drawn_vertices_) {
    low = glm::min(low, position_px[v]);
    high = glm::max(high, position_px[v]);
  }
  if (!(low.x <= high.x && low.y <= high.y)) return {};
  low = glm::max(low, -kFar_px);
  high = glm::min(high, kFar_px);
  return {static_cast<int>(std::floor(low.x)), static_cast<int>(std::floor(low.y)),
          static_cast<int>(std::ceil(high.x)) + 1, static_cast<int>(std::ceil(high.y)) + 1};
}

}  // namespace handcast::renderer
