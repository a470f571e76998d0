// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "renderer/base/landmark_points.hpp"
#include "renderer/mask/silhouette.hpp"

namespace handcast::renderer {

/// Points on the edge of a silhouette, to a fraction of a pixel, evenly spaced, in no particular
/// order.
struct Contour {
  /// Capacity. If the edge has more points, every 2nd, 4th, ... is kept.
  static constexpr int kMostPoints = 640;

  int count = 0;                                 ///< entries in use of the arrays below
  std::array<glm::vec2, kMostPoints> points_px;  ///< image px
  std::array<glm::vec2, kMostPoints> normals;    ///< unit, away from the hand
};

/// Replaces `contour` by the edge of `silhouette`.
void find_contour(const Silhouette& silhouette, Contour& contour);

/// Distance in px from `from` along `direction` (unit) to the edge of the hand; negative if `from`
/// is outside the hand and the edge lies in the opposite direction. Empty if there is no edge
/// within `reach_px`.
std::optional<float> edge_along(const Silhouette& silhouette, glm::vec2 from, glm::vec2 direction,
                                float reach_px);

/// The landmarks of one hand at two times, by the tracker's motion, image px.
struct HandMotion {
  LandmarkPoints then{};  ///< when the contour was taken
  LandmarkPoints now{};   ///< in the newest image
};

/// The position of the contour of one hand in a newer image.
struct Registered {
  bool found = false;      ///< false: the contour was not found, `moved` is 0
  LandmarkPoints moved{};  ///< displacement of the landmarks from HandMotion::now, image px
  int points = 0;          ///< points of the contour whose edge was found
  /// Median distance of the contour from the edge, before and after registration.
  /// @{
  float before_px = 0, after_px = 0;
  /// @}
};

/// Finds the contour of a hand again in a newer image. Its points are carried along with the
/// nearest bone by the tracker's motion; each searches the edge along its normal. Robust
/// Gauss-Newton steps find the translation and rotation of the hand and the rotation and stretch of
/// each finger that bring the points to the edge. Priors limit the unknowns that too few points
/// determine. See `docs/method.md#register`. Calls are independent of each other. One thread.
class Registration {
 public:
  /// `limit_px`: the farthest an edge is searched and a landmark may be moved.
  explicit Registration(float limit_px) : limit_px_(limit_px) {}

  /// Registers the hand `index` of `hands` (at most two). Points of the contour that are nearer to
  /// the other hand are not used.
  Registered find(const Contour& outline, const Silhouette& newest,
                  std::span<const HandMotion> hands, std::size_t index);

 private:
  static constexpr int kUnknowns = 3 + 2 * kFingers;
  struct Point {
    glm::vec2 at, normal;  ///< after the tracker's motion
    int finger;            ///< -1: palm
    bool seen;
    float distance_px;  ///< from the moved point to the edge, along the normal
    /// Derivatives of the motion along the normal by the unknowns: translation, rotation, and the
    /// rotation and stretch of its finger.
    std::array<float, 5> row;
  };
  struct Finger {
    glm::vec2 knuckle, axis;
    float length_px;
  };

  void carry(const Contour& outline, std::span<const HandMotion> hands, std::size_t index);
  void find_edges(const Silhouette& newest, float reach_px);
  void step(int unknowns);
  glm::vec2 displacement(glm::vec2 at, int finger) const;
  float median_distance();
  void set_rows(const LandmarkPoints& now);

  float limit_px_;
  int count_ = 0;
  std::array<Point, Contour::kMostPoints> points_{};
  std::array<float, Contour::kMostPoints> sorted_{};
  std::array<Finger, kFingers> fingers_;
  glm::vec2 centre_{0};
  std::array<float, kUnknowns> solution_;
};

}  // namespace handcast::renderer
