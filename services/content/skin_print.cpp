// SPDX-License-Identifier: Apache-2.0
#include "services/content/skin_print.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace handcast::content {
namespace {

/// The levels of a texel, 0..255.
glm::vec4 levels_of(std::uint32_t texel) {
  return {texel & 0xff, texel >> 8 & 0xff, texel >> 16 & 0xff, texel >> 24};
}

std::uint32_t packed(const glm::vec4& levels) {
  std::uint32_t texel = 0;
  for (int c = 3; c >= 0; --c)
    texel = texel << 8 | static_cast<std::uint32_t>(std::clamp(levels[c] + 0.5f, 0.f, 255.f));
  return texel;
}

/// The picture at a place, interpolated linearly; its edge is continued.
std::uint32_t sample(const renderer::Texture& picture, const glm::vec2& place) {
  const glm::vec2 at =
      glm::clamp(place, glm::vec2(0), glm::vec2(picture.width() - 1, picture.height() - 1));
  const int x = static_cast<int>(at.x), y = static_cast<int>(at.y),
            right = std::min(x + 1, picture.width() - 1),
            below = std::min(y + 1, picture.height() - 1);
  const glm::vec2 part = at - glm::vec2(x, y);
  const auto mix = [&](int row) {
    return glm::mix(levels_of(picture.at(x, row)), levels_of(picture.at(right, row)), part.x);
  };
  return packed(glm::mix(mix(y), mix(below), part.y));
}

}  // namespace

SkinPrint::Graph::Graph(const renderer::HandMesh& mesh) {
  std::map<std::array<float, 3>, std::size_t> known;
  for (const auto& at : mesh.positions)
    place_.push_back(known.try_emplace({at.x, at.y, at.z}, known.size()).first->second);
  neighbours_.resize(known.size());
  for (const auto& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = place_[triangle[k]], b = place_[triangle[(k + 1) % 3]];
      neighbours_[a].push_back(b);
      neighbours_[b].push_back(a);
    }
}

std::vector<glm::vec4> SkinPrint::Graph::spread(std::span<const glm::vec4> sums,
                                                std::span<const float> weights) const {
  std::vector<glm::vec4> means(neighbours_.size(), glm::vec4(0));
  std::vector<float> total(neighbours_.size());
  for (std::size_t v = 0; v < place_.size(); ++v) {
    means[place_[v]] += sums[v];
    total[place_[v]] += weights[v];
  }
  std::vector<std::size_t> ring;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (total[i] == 0) continue;
    means[i] /= total[i];
    ring.push_back(i);
  }
  while (!ring.empty()) ring = grow(ring, means, total);
  std::vector<glm::vec4> per_vertex;
  for (const auto place : place_) per_vertex.push_back(means[place]);
  return per_vertex;
}

/// Gives the neighbours of a ring that have nothing their means, and returns them.
std::vector<std::size_t> SkinPrint::Graph::grow(const std::vector<std::size_t>& ring,
                                                std::vector<glm::vec4>& means,
                                                std::vector<float>& total) const {
  std::vector<std::size_t> next;
  for (const auto from : ring)
    for (const auto to : neighbours_[from])
      if (total[to] == 0) next.push_back(to);
  std::ranges::sort(next);
  next.erase(std::unique(next.begin(), next.end()), next.end());
  for (const auto to : next) {
    float count = 0;
    for (const auto from : neighbours_[to]) {
      if (total[from] == 0) continue;
      means[to] += means[from];
      ++count;
    }
    means[to] /= count;
  }
  for (const auto to : next) total[to] = 1;
  return next;
}

SkinPrint::SkinPrint(const renderer::HandMesh& mesh, int width, int height)
    : mesh_(mesh),
      map_(surface_map_of(mesh, width, height)),
      graph_(mesh),
      texels_(map_->texels().size()),
      is_lit_(map_->texels().size()) {}

void SkinPrint::take(const Viewer& projector, const HandState& hand, const HandState* other,
                     const renderer::Texture& picture, const PictureFrame& frame) {
  for (const auto& [which, px] : seen_texels(projector, *map_, hand, other)) {
    texels_[which] = sample(picture, px * frame.scale + frame.shift);
    is_lit_[which] = true;
  }
}

void SkinPrint::clear() { is_lit_.assign(is_lit_.size(), false); }

void SkinPrint::show(bool is_filled, renderer::Texture& out) const {
  const auto texels = map_->texels();
  const auto around = is_filled ? colours_around() : std::vector<glm::vec4>();
  for (std::size_t i = 0; i < texels.size(); ++i) {
    std::uint32_t& texel = out.pixels()[texels[i].index];
    if (is_lit_[i])
      texel = texels_[i];
    else
      texel = is_filled ? packed(texels[i].of(std::span(around))) : 0;
  }
  map_->pad(out);
}

/// Per vertex: the levels of the lit texels around it, or those of the nearest lit skin.
std::vector<glm::vec4> SkinPrint::colours_around() const {
  const auto texels = map_->texels();
  std::vector<glm::vec4> sums(mesh_.vertex_count(), glm::vec4(0));
  std::vector<float> weights(mesh_.vertex_count());
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!is_lit_[i]) continue;
    const glm::vec4 levels = levels_of(texels_[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      sums[texels[i].corners[k]] += texels[i].parts[k] * levels;
      weights[texels[i].corners[k]] += texels[i].parts[k];
    }
  }
  return graph_.spread(sums, weights);
}

}  // namespace handcast::content
