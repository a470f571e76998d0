// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>

#include "renderer/draw/gl/objects.hpp"
#include "renderer/draw/painter.hpp"

namespace handcast::renderer::gl {

/// The parts of a hand that do not change from frame to frame, in the GPU's memory.
struct HandAssets {
  Buffer vertices;             ///< per vertex: texture coordinates (2 floats), chart (uint)
  Buffer triangles;            ///< three indices of 16 bits each
  GLsizei index_count = 0;     ///< three times the number of triangles
  Image2d content;             ///< R32UI: MipChain::texels()
  glm::ivec4 picture{};        ///< see `picture` in shaders/common.glsl
  std::uint64_t revision = 0;  ///< DrawnHand::revision of the copy
  std::uint64_t used = 0;      ///< number of the last draw that used it

  /// Bytes of a vertex.
  static constexpr GLsizei kVertexBytes = 12;
};

/// Keeps the assets of the hands drawn last, by DrawnHand::revision.
class AssetCache {
 public:
  /// Without assets.
  explicit AssetCache(Context& context) : context_(context) {}

  /// The assets of each of up to four hands, copied if they are new. Valid until the next call.
  std::span<const HandAssets* const> find(std::span<const DrawnHand> hands);

 private:
  static constexpr std::size_t kKept = 8;

  HandAssets& assets_of(const DrawnHand& hand);
  HandAssets copy(const DrawnHand& hand);

  Context& context_;
  std::vector<std::unique_ptr<HandAssets>> kept_;
  std::vector<const HandAssets*> found_;
  std::uint64_t draws_ = 0;
};

}  // namespace handcast::renderer::gl
