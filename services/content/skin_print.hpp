// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "services/content/unwrap.hpp"

namespace handcast::content {

/// Where a picture has the colour of a projector's pixel: px * scale + shift, whole numbers at the
/// centres of its pixels.
struct PictureFrame {
  glm::vec2 scale{1}, shift{0};
};

/// A picture of the projector's plane on the skin of a hand. One thread.
class SkinPrint {
 public:
  /// For textures of this size. The mesh outlives it.
  SkinPrint(const renderer::HandMesh& mesh, int width, int height);

  /// Takes the picture where the light falls onto the hand; other skin keeps what it had.
  void take(const Viewer& projector, const HandState& hand, const HandState* other,
            const renderer::Texture& picture, const PictureFrame& frame);
  /// No skin was ever lit.
  void clear();
  /// Draws it. Skin that was never lit gets the colours of the skin around it, or none.
  void show(bool is_filled, renderer::Texture& out) const;

 private:
  /// Which vertices are neighbours on the skin, across the seams of its texture, too.
  class Graph {
   public:
    explicit Graph(const renderer::HandMesh& mesh);
    /// The means of sums per vertex and their weights. Vertices at one place share theirs. One
    /// without a weight gets the mean of its neighbours, ring by ring; 0 if none is connected to
    /// it.
    std::vector<glm::vec4> spread(std::span<const glm::vec4> sums,
                                  std::span<const float> weights) const;

   private:
    std::vector<std::size_t> grow(const std::vector<std::size_t>& ring,
                                  std::vector<glm::vec4>& means, std::vector<float>& total) const;

    std::vector<std::size_t> place_;                    ///< per vertex
    std::vector<std::vector<std::size_t>> neighbours_;  ///< per place
  };

  std::vector<glm::vec4> colours_around() const;

  const renderer::HandMesh& mesh_;
  std::shared_ptr<const SurfaceMap> map_;
  Graph graph_;
  std::vector<std::uint32_t> texels_;  ///< per texel of the map, as last lit
  std::vector<bool> is_lit_;           ///< whether it ever was
};

}  // namespace handcast::content
