// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <stop_token>

#include "services/content/projegraphy/animals.hpp"
#include "services/content/projegraphy/silhouette.hpp"

namespace handcast::projegraphy {

/// A similarity: to = scale * R(angle) * mirror * from + shift, y down, angles clockwise.
struct Placement {
  float scale = 1, angle_rad = 0;
  bool is_mirrored = false;  ///< in x, before all else
  glm::vec2 shift{0};

  glm::vec2 operator()(glm::vec2 at) const;
};

/// What a silhouette resembles.
struct Recognised {
  int animal = -1;           ///< index into animals(); -1: none of them is near enough
  float distance = 1;        ///< 0: the same shape
  float runner_up = 1;       ///< the distance of the next animal
  bool is_mirrored = false;  ///< relative to the hands of the table
  float unit_px = 1;         ///< of the mask: the root of the animal's area
  /// The joints of the animal's hands (the left one's, then the right one's) on the silhouette,
  /// mask px.
  std::vector<glm::vec2> joints_px;
};

/// Knows animals by their silhouettes, which it makes of the hands of a rig. Recognition compares
/// outlines by an oriented chamfer distance (Shotton et al. 2008, "Multiscale Categorical Object
/// Recognition Using Contour Fragments"), and areas. Const functions by any thread.
class Recogniser {
 public:
  /// Copies what it needs of the meshes, left and right. It takes most of a second; a stop leaves
  /// it incomplete.
  explicit Recogniser(const std::array<const renderer::HandMesh*, 2>& meshes,
                      const std::stop_token& stop = {});
  Recogniser(Recogniser&&) noexcept;
  ~Recogniser();

  /// What a silhouette resembles most, or none of the animals; empty without a silhouette.
  std::optional<Recognised> recognise(const Silhouette& silhouette) const;
  /// The place of this animal on a silhouette.
  std::optional<Recognised> place(const Silhouette& silhouette, int animal) const;

 private:
  struct Shapes;
  std::unique_ptr<const Shapes> shapes_;
};

}  // namespace handcast::projegraphy
