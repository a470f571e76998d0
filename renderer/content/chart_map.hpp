// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// A place of a hand at rest in the axes of its wrist: x to the right and z to the arm, seen from
/// the back, however the model lies.
inline glm::vec3 in_wrist_mm(const HandMesh& hand, const glm::vec3& place_mm) {
  return glm::transpose(glm::mat3(hand.rest[1])) * (place_mm - 1000.f * glm::vec3(hand.rest[1][3]));
}

/// The part of the hand at the centre of a texel.
struct ChartTexel {
  std::uint8_t chart = 0;    ///< 0: none
  std::uint8_t joint = 0;    ///< the joint with the largest skin weight
  std::uint8_t edge_px = 0;  ///< distance to the outline of the chart, at most ChartMap::kEdgeReach
  glm::vec2 rest_mm{};       ///< position on the hand at rest, in_wrist_mm()
};

/// The charts of a hand, drawn into a texture.
class ChartMap {
 public:
  /// The distance to an outline is measured up to here, texels.
  static constexpr int kEdgeReach = 4;

  /// Draws the charts of `hand` into a texture of the given size in texels.
  ChartMap(const HandMesh& hand, int width, int height);

  /// The texel (x, y).
  const ChartTexel& at(int x, int y) const { return texels_.at(x, y); }
  /// +1 if the chart shows the back of the hand, -1 if it shows the palm.
  float facing(std::uint8_t chart) const { return facing_[chart]; }
  /// Gives each texel within 32 texels of a chart the colour of the nearest texel on a chart.
  /// `texture` has the size of the map.
  void pad(Texture& texture) const;

 private:
  void draw_triangle(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners);
  void measure_edges();

  Image<ChartTexel> texels_;
  Image<std::uint8_t> on_, off_;  ///< 1 where there is a chart, and where there is none
  std::array<float, 256> facing_{};
};

}  // namespace handcast::renderer
