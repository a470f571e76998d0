// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "services/lab/twin/surface.hpp"
#include "services/lab/twin/twin.hpp"

namespace handcast::twin {

/// The surface at a projector pixel: kNothing, kArm, or a triangle of a hand.
using Surface = std::uint32_t;
inline constexpr Surface kNothing = 0, kArm = 1, kFirstTriangle = 2;
/// A triangle of the hand with an index in TrueView::hands().
/// @{
constexpr Surface surface_of(std::size_t hand, std::size_t triangle) {
  return kFirstTriangle + static_cast<Surface>(hand << 16 | triangle);
}
constexpr bool is_hand(Surface surface) { return surface >= kFirstTriangle; }
constexpr std::size_t hand_of(Surface surface) { return (surface - kFirstTriangle) >> 16; }
constexpr std::size_t triangle_of(Surface surface) { return (surface - kFirstTriangle) & 0xffff; }
/// @}

/// A true hand as the projector's light meets it.
struct SeenHand {
  Side side = Side::left;
  const TrueHand* truth = nullptr;
  std::vector<glm::vec3> position_m;  ///< by vertex, camera space
  ScreenVertices screen;              ///< by vertex, projector px
  /// By vertex.
  /// @{
  std::vector<glm::vec2> velocity_px_s;
  std::vector<glm::vec3> velocity_m_s;
  /// @}
  std::array<glm::vec2, msg::kJoints> joints_px;  ///< projector px
  ScreenVertices arm;                             ///< the forearm's vertices
};

/// The point of a surface of a hand with these barycentrics in its triangle, camera space, m.
inline glm::vec3 point_of(const SeenHand& hand, Surface surface, const glm::vec3& share) {
  const auto& [i, j, k] = hand.truth->mesh.triangles[triangle_of(surface)];
  return share.x * hand.position_m[i] + share.y * hand.position_m[j] + share.z * hand.position_m[k];
}

/// The true hands at one time, drawn into the image of a projector as it really is. Reuses its
/// buffers. One thread.
class TrueView {
 public:
  /// For images of the projector of `seen`, which is the twin's true calibration or differs from it
  /// in the projector. `twin` must outlive it.
  TrueView(const Twin& twin, const calib::Calibration& seen);

  /// Poses the hands of a time.
  void pose(std::int64_t time_ns);
  /// Draws them, and their arms, into `area`, which must lie in the image.
  void draw(const renderer::Rect& area);

  /// The hands of that time.
  std::span<const SeenHand> hands() const { return {seen_.data(), count_}; }
  /// What is at each pixel of the area that was drawn last.
  renderer::View<const Surface> surface() const { return surface_.view(); }
  /// The whole image.
  renderer::Rect screen() const { return {0, 0, surface_.width(), surface_.height()}; }
  /// The pixel that lights a point in camera space, m.
  glm::vec2 to_projector(const glm::vec3& camera_m) const {
    const glm::dvec3 seen = at(camera_m);
    return glm::vec2(glm::dvec2(seen) / seen.z);
  }
  /// The pixel that lights a point of a hand in camera space; empty if it lies outside the area
  /// that was drawn last, or something is in between.
  std::optional<glm::ivec2> lit_by(const glm::vec3& camera_m) const;

 private:
  std::optional<JointFrames> joints_in_camera(Side side, std::int64_t time_ns) const;
  void pose_hand(SeenHand& hand, Side side, std::int64_t time_ns, const JointFrames& joints);
  void find_velocities(SeenHand& hand, std::int64_t time_ns, const JointFrames& joints);
  void pose_arm(SeenHand& hand, const JointFrames& joints);
  void project(std::span<const glm::vec3> positions, ScreenVertices& screen) const;
  void draw_hand(std::size_t index, const renderer::Rect& area);

  glm::dvec3 at(const glm::vec3& camera_m) const { return projection_ * glm::dvec4(camera_m, 1); }

  const Twin& twin_;
  glm::dmat4x3 projection_;  ///< calib::Calibration::projection()
  float front_;              ///< sign of the area of triangles that face the projector
  std::array<std::vector<float>, 2> behind_wrist_m_;
  std::array<Forearm, 2> forearms_;
  std::array<SeenHand, 2> seen_;
  std::size_t count_ = 0;
  std::vector<glm::vec3> before_, after_;
  renderer::Rect drawn_;  ///< the area of draw()
  renderer::Image<Surface> surface_;
  renderer::Image<float> inverse_depth_;
};

}  // namespace handcast::twin
