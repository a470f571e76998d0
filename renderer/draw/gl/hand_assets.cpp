// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/hand_assets.hpp"

#include <algorithm>

namespace handcast::renderer::gl {
namespace {

struct Vertex {
  glm::vec2 uv;
  std::uint32_t chart;
};
static_assert(sizeof(Vertex) == HandAssets::kVertexBytes);

Image2d copy_texels(Context& context, View<const std::uint32_t> texels) {
  Image2d image = make_image(context, GL_R32UI, texels.width, texels.height);
  context.gl().TextureSubImage2D(image.name(), 0, 0, 0, texels.width, texels.height, GL_RED_INTEGER,
                                 GL_UNSIGNED_INT, texels.data);
  return image;
}

}  // namespace

HandAssets AssetCache::copy(const DrawnHand& hand) {
  static const MipChain kWhite;
  const MipChain& content = hand.texture != nullptr ? *hand.texture : kWhite;
  const HandMesh& mesh = *hand.mesh;
  std::vector<Vertex> vertices(mesh.vertex_count());
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = {mesh.uv[i], mesh.chart[i]};
  return {make_buffer(context_, vertices.size() * sizeof(Vertex), 0, vertices.data()),
          make_buffer(context_, mesh.triangles.size() * sizeof(mesh.triangles[0]), 0,
                      mesh.triangles.data()),
          static_cast<GLsizei>(3 * mesh.triangles.size()),
          copy_texels(context_, content.texels()),
          {content.width(), content.height(), content.padded_height(),
           content.smooth() ? content.levels() - 1 : -1},
          hand.revision};
}

HandAssets& AssetCache::assets_of(const DrawnHand& hand) {
  if (hand.revision != 0) {
    for (const auto& one : kept_)
      if (one->revision == hand.revision) return *one;
  }
  return *kept_.emplace_back(std::make_unique<HandAssets>(copy(hand)));
}

std::span<const HandAssets* const> AssetCache::find(std::span<const DrawnHand> hands) {
  ++draws_;
  std::erase_if(kept_, [](const auto& one) { return one->revision == 0; });
  while (kept_.size() > kKept)
    kept_.erase(std::ranges::min_element(kept_, {}, [](const auto& one) { return one->used; }));
  found_.clear();
  for (const DrawnHand& hand : hands) {
    HandAssets& assets = assets_of(hand);
    assets.used = draws_;
    found_.push_back(&assets);
  }
  return found_;
}

}  // namespace handcast::renderer::gl
