// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"
#include "renderer/hand/hand_mesh.hpp"

namespace handcast::content {

/// A texel whose centre lies on the hand.
struct SurfaceTexel {
  std::uint32_t index = 0;                 ///< in the texture, row after row
  std::array<std::uint16_t, 3> corners{};  ///< vertices of the triangle that it lies in
  std::array<float, 3> parts{};            ///< their shares, with sum 1

  /// What is known per vertex, at the texel.
  template <class T>
  T of(std::span<const T> per_vertex) const {
    return per_vertex[corners[0]] * parts[0] + per_vertex[corners[1]] * parts[1] +
           per_vertex[corners[2]] * parts[2];
  }
};

/// Where each texel of a texture lies on the surface of a hand, however the hand is posed.
class SurfaceMap {
 public:
  /// How far pad() continues a chart, texels: the fill and the mip levels look up texels there. The
  /// fill looks farther in a larger texture; see bench_frame_seams.
  static int padding_of(int width) { return std::clamp(width / 32, 8, 32); }

  /// Of a texture of the given size.
  SurfaceMap(const renderer::HandMesh& hand, int width, int height);

  /// All texels on the hand, row after row. A place that triangles share belongs to one of them.
  std::span<const SurfaceTexel> texels() const { return texels_; }
  /// Copies the outermost texels of the charts outwards, and clears everything else that is not on
  /// the hand. `texture` has the size of the map.
  void pad(renderer::Texture& texture) const;

 private:
  /// A texel beside a chart, and the nearest one on it.
  struct Copy {
    std::uint32_t to, from;
  };

  std::vector<SurfaceTexel> texels_;
  std::vector<Copy> copies_;
  std::vector<std::uint32_t> empty_;
};

/// The map of a texture, which is made once for all sources. One thread.
std::shared_ptr<const SurfaceMap> surface_map_of(const renderer::HandMesh& hand, int width,
                                                 int height);

/// The positions of the vertices at rest in the axes of the wrist, mm: x to the right, y out of the
/// back, z to the arm.
std::vector<glm::vec3> rest_positions_mm(const renderer::HandMesh& hand);
/// Their unit normals in these axes.
std::vector<glm::vec3> rest_normals(const renderer::HandMesh& hand);

/// A colour 0..1 (red, green, blue, alpha; not premultiplied) as a texel, which is premultiplied.
std::uint32_t texel_of(const glm::vec4& colour);

}  // namespace handcast::content
