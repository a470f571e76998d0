// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/texture_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace handcast::twin {
namespace {

using Corners = std::array<glm::vec2, 3>;

float cross(const glm::vec2& a, const glm::vec2& b) { return a.x * b.y - a.y * b.x; }

/// The nearest point of the edge from `a` to `b`, as the share of `b`.
float nearest_on_edge(const glm::vec2& p, const glm::vec2& a, const glm::vec2& b) {
  const glm::vec2 ab = b - a;
  const float square = glm::dot(ab, ab);
  return square > 0 ? std::clamp(glm::dot(p - a, ab) / square, 0.0f, 1.0f) : 0;
}

/// The barycentric coordinates of a point in a triangle; empty if it is outside.
std::optional<glm::vec3> inside(const glm::vec2& p, const Corners& corners) {
  const auto& [a, b, c] = corners;
  const float area = cross(b - a, c - a);
  if (area == 0) return std::nullopt;
  const glm::vec3 share(cross(b - p, c - p) / area, cross(c - p, a - p) / area,
                        cross(a - p, b - p) / area);
  if (share.x < 0 || share.y < 0 || share.z < 0) return std::nullopt;
  return share;
}

/// The barycentric coordinates of the nearest point of the edge of a triangle.
glm::vec3 nearest_in(const glm::vec2& p, const Corners& corners) {
  glm::vec3 best(1, 0, 0);
  float best_square = std::numeric_limits<float>::max();
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const float part = nearest_on_edge(p, corners[k], corners[next]);
    const glm::vec2 d = glm::mix(corners[k], corners[next], part) - p;
    if (glm::dot(d, d) >= best_square) continue;
    best_square = glm::dot(d, d);
    best = glm::vec3(0);
    best[k] = 1 - part;
    best[next] = part;
  }
  return best;
}

glm::vec2 place(const Corners& corners, const glm::vec3& share) {
  return share.x * corners[0] + share.y * corners[1] + share.z * corners[2];
}

}  // namespace

int TextureLookup::cell_of(float share) {
  return std::clamp(static_cast<int>(std::floor(share * kCells)), 0, kCells - 1);
}

TextureLookup::TextureLookup(const renderer::HandMesh& mesh)
    : cells_(static_cast<std::size_t>(kCells) * kCells) {
  for (const auto& [a, b, c] : mesh.triangles)
    corners_.push_back({mesh.uv[a], mesh.uv[b], mesh.uv[c]});
  for (std::size_t t = 0; t < corners_.size(); ++t) enter(static_cast<std::uint16_t>(t));
}

void TextureLookup::enter(std::uint16_t triangle) {
  const auto& [a, b, c] = corners_[triangle];
  const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  for (int y = cell_of(low.y); y <= cell_of(high.y); ++y)
    for (int x = cell_of(low.x); x <= cell_of(high.x); ++x) cells_[index(x, y)].push_back(triangle);
}

SurfacePoint TextureLookup::at(glm::vec2 uv) const {
  const int column = cell_of(uv.x), row = cell_of(uv.y);
  for (const std::uint16_t t : cells_[index(column, row)])
    if (const auto share = inside(uv, corners_[t])) return {t, *share};
  SurfacePoint best;
  float best_square = std::numeric_limits<float>::max();
  // A ring of cells that is farther away than the best point so far cannot have a nearer one.
  for (int ring = 0; ring < kCells; ++ring) {
    const float gap = static_cast<float>(ring - 1) / kCells;
    if (ring > 0 && best_square <= gap * gap) break;
    for (int y = std::max(row - ring, 0); y <= std::min(row + ring, kCells - 1); ++y)
      for (int x = std::max(column - ring, 0); x <= std::min(column + ring, kCells - 1); ++x) {
        if (std::max(std::abs(x - column), std::abs(y - row)) != ring) continue;
        for (const std::uint16_t t : cells_[index(x, y)]) {
          const glm::vec3 share = nearest_in(uv, corners_[t]);
          const glm::vec2 d = place(corners_[t], share) - uv;
          if (glm::dot(d, d) >= best_square) continue;
          best_square = glm::dot(d, d);
          best = {t, share};
        }
      }
  }
  return best;
}

PlacedTexture::PlacedTexture(const Twin& twin)
    : twin_(twin),
      lookup_{TextureLookup(twin.hands().drawn(Side::left)),
              TextureLookup(twin.hands().drawn(Side::right))} {}

void PlacedTexture::place(const SeenHand& hand) {
  const auto& map = twin_.hands().texture(hand.side);
  auto& placed = placed_[static_cast<std::size_t>(hand.side)];
  const auto& mesh = hand.truth->mesh;
  placed.seen_m.resize(map.size());
  placed.rest_m.resize(map.size());
  for (std::size_t v = 0; v < map.size(); ++v) {
    placed.seen_m[v] = map[v].on(mesh, hand.position_m);
    placed.rest_m[v] = map[v].on(mesh, mesh.positions);
  }
}

PlacedTexture::Point PlacedTexture::at(Side side, glm::vec2 uv) const {
  const auto s = static_cast<std::size_t>(side);
  const SurfacePoint point = lookup_[s].at(uv);
  const auto& mesh = twin_.hands().drawn(side);
  return {point.on(mesh, placed_[s].seen_m), point.on(mesh, placed_[s].rest_m)};
}

}  // namespace handcast::twin
