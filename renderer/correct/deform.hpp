// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "config/sections/cascade.hpp"
#include "renderer/base/image.hpp"
#include "renderer/base/landmark_points.hpp"
#include "renderer/hand/hand_mesh.hpp"

/// Moving the drawing onto the landmarks. All points here are projector pixels.
namespace handcast::renderer {

/// Similarity moving least squares (Schaefer et al. 2006, section 2.2) from points `p` to points
/// `q`, weights |p - v|^(-2 alpha).
class MovingLeastSquares {
 public:
  MovingLeastSquares(std::span<const glm::vec2> p, std::span<const glm::vec2> q, float alpha);
  glm::vec2 operator()(glm::vec2 v) const;
  /// Moves every point of `points` in place (vectorised).
  void apply(std::span<glm::vec2> points) const;

 private:
  std::vector<glm::vec2> p_, q_;
  float alpha_;
};

/// A regular grid over an image, each node moved: a piecewise linear warp, each cell split along
/// its diagonal (0,0)-(1,1).
struct WarpGrid {
  int columns = 0, rows = 0;  ///< nodes
  Rect area;  ///< the image area the undeformed grid spans, corner nodes on its corner pixels
  std::vector<glm::vec2> nodes;  ///< moved positions, row by row

  glm::vec2 source(int column, int row) const;  ///< where a node stood
  glm::vec2 operator()(
      glm::vec2 v) const;  ///< the warp at any point (outside the area: of the nearest cell)
  int foldovers() const;   ///< triangles turned over
};

/// The paper's correction: `settings.grid_columns x grid_rows` nodes over the whole image.
WarpGrid make_warp_grid(const config::Correct& settings, Rect area,
                        const MovingLeastSquares& field);

/// Our correction: the vertices of one drawn hand, moved in place by per-bone similarities P -> Q
/// blended with the skin weights, handing over to moving least squares where a bone is
/// foreshortened (METHOD section 2).
void correct_vertices(const config::Correct& settings, const HandMesh& hand,
                      std::span<const glm::vec2, kLandmarks> p,
                      std::span<const glm::vec2, kLandmarks> q, std::span<glm::vec2> vertices);

}  // namespace handcast::renderer
