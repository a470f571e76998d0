// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <span>

#include "renderer/base/landmark_points.hpp"
#include "renderer/register/contour.hpp"

namespace handcast::renderer {

/// One hand at two times, image px: where its landmarks were when the outline was taken, and where
/// the tracker's motion takes them.
struct HandMotion {
  LandmarkPoints then{}, now{};
};

/// How one hand's outline lies in a newer image.
struct Registered {
  bool found = false;                 ///< false: nothing is moved
  LandmarkPoints moved{};             ///< what the landmarks moved beyond HandMotion::now, image px
  int points = 0;                     ///< of the outline, whose edge was found again
  float before_px = 0, after_px = 0;  ///< median distance of outline and edge
};

/// Finds an outline again in the newest image (METHOD section 2, late registration): carried there
/// with the nearest bone, its points look for the edge along their normals, and robust Gauss-Newton
/// steps find the shift and turn of the hand and the turn and stretch of each finger that bring
/// them there. Priors hold what too few points tell. Remembers nothing but its memory.
class Registration {
 public:
  explicit Registration(float limit_px) : limit_px_(limit_px) {}

  /// The hand `index` of `hands` (two at most); points of the outline nearer to the other hand are
  /// not its own.
  Registered find(const Contour& outline, const Silhouette& newest,
                  std::span<const HandMotion> hands, std::size_t index);

 private:
  static constexpr int kFingers = 5, kUnknowns = 3 + 2 * kFingers;
  struct Point {
    glm::vec2 at, normal;  ///< as carried by the tracker's motion
    int finger;            ///< -1: palm
    bool seen;
    float distance_px;         ///< from the point as moved so far to the edge, along the normal
    std::array<float, 5> row;  ///< what the unknowns (shift, turn, its finger's turn and stretch)
                               ///< do along the normal
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
  std::array<Point, Contour::kMostPoints> points_;
  std::array<float, Contour::kMostPoints> sorted_;
  std::array<Finger, kFingers> fingers_;
  glm::vec2 centre_{0};
  std::array<float, kUnknowns> solution_;
};

}  // namespace handcast::renderer
