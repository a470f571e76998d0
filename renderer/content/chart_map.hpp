// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::renderer {

/// What of the hand a texel's centre shows.
struct ChartTexel {
  std::uint8_t chart = 0;    ///< 0: none
  std::uint8_t joint = 0;    ///< the joint that moves it most
  std::uint8_t edge_px = 0;  ///< distance to the chart's outline, 32 and more: far
  glm::vec3 rest_mm{};       ///< on the hand at rest: +x right, +y out of the back, -z to the tips
};

/// The hand's charts drawn into a texture of the given size.
class ChartMap {
 public:
  ChartMap(const HandMesh& hand, int width, int height);

  const ChartTexel& at(int x, int y) const { return texels_.at(x, y); }
  /// +1 where the chart shows the back of the hand, -1 where it shows the palm.
  float facing(std::uint8_t chart) const { return facing_[chart]; }
  /// Carries the colours of the charts outwards (32 px), each texel taking its nearest one on a
  /// chart.
  void pad(Image<glm::vec3>& colours) const;

 private:
  void draw_triangle(const HandMesh& hand, const std::array<std::uint16_t, 3>& corners);
  void measure_edges();

  Image<ChartTexel> texels_;
  std::array<float, 256> facing_{};
};

}  // namespace handcast::renderer
