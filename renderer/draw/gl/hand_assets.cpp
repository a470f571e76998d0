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

Image2d copy_texture(Context& context, const Texture* texture) {
  static const Texture kWhite(1, 1, 0xffffffff);
  if (texture == nullptr) texture = &kWhite;
  Image2d image = make_image(context, GL_R32UI, texture->width(), texture->height());
  context.gl().TextureSubImage2D(image.name(), 0, 0, 0, texture->width(), texture->height(),
                                 GL_RED_INTEGER, GL_UNSIGNED_INT, texture->pixels().data());
  return image;
}

}  // namespace

HandAssets AssetCache::copy(const DrawnHand& hand) {
  const HandMesh& mesh = *hand.mesh;
  std::vector<Vertex> vertices(mesh.vertex_count());
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = {mesh.uv[i], mesh.chart[i]};
  return {make_buffer(context_, vertices.size() * sizeof(Vertex), 0, vertices.data()),
          make_buffer(context_, mesh.triangles.size() * sizeof(mesh.triangles[0]), 0,
                      mesh.triangles.data()),
          static_cast<GLsizei>(3 * mesh.triangles.size()), copy_texture(context_, hand.texture),
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
