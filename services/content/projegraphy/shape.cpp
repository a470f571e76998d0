// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "services/content/projegraphy/recogniser.hpp"

namespace handcast::projegraphy {
namespace {

constexpr std::size_t kPoints = 140;  ///< of an outline
constexpr float kPi = std::numbers::pi_v<float>;

int mask_at(const renderer::Image<std::uint8_t>& mask, int x, int y) {
  return x >= 0 && y >= 0 && x < mask.width() && y < mask.height() ? mask.at(x, y) : 0;
}

/// Spreads distances over a grid in two passes (Borgefors 1986, weights 3 and 4 by 3).
void spread(renderer::Image<float>& grid, float cell) {
  const float straight = cell, diagonal = cell * 4 / 3;
  const int w = grid.width(), h = grid.height();
  const auto nearer = [&](int x, int y, int dx, int dy) {
    const int u = x + dx, v = y + dy;
    if (u < 0 || v < 0 || u >= w || v >= h) return;
    grid.at(x, y) =
        std::min(grid.at(x, y), grid.at(u, v) + (dx != 0 && dy != 0 ? diagonal : straight));
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}})
        nearer(x, y, dx, dy);
  for (int y = h - 1; y >= 0; --y)
    for (int x = w - 1; x >= 0; --x)
      for (const auto& [dx, dy] : {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}}) nearer(x, y, dx, dy);
}

}  // namespace

Shape::Shape(const Silhouette& silhouette) : area_(kCells, kCells) {
  glm::dvec2 sum(0);
  for (int y = 0; y < silhouette.mask.height(); ++y)
    for (int x = 0; x < silhouette.mask.width(); ++x)
      if (silhouette.mask.at(x, y)) sum += glm::dvec2(x, y);
  const double area = std::max(1, silhouette.area_px);
  centre_px_ = glm::vec2(sum / area);
  unit_px_ = static_cast<float>(std::sqrt(area));
  find_outline(silhouette);
  find_distances();
  for (int y = 0; y < kCells; ++y)
    for (int x = 0; x < kCells; ++x) {
      const glm::ivec2 px(
          glm::round(to_mask((glm::vec2(x, y) + 0.5f) * (2 * kReach / kCells) - kReach)));
      area_.at(x, y) = static_cast<std::uint8_t>(mask_at(silhouette.mask, px.x, px.y));
    }
}

/// Pixels of the area that touch something else, with the direction in which it lies.
void Shape::find_outline(const Silhouette& silhouette) {
  const auto& mask = silhouette.mask;
  std::vector<Point> all;
  constexpr int kRadius = 3;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (!mask.at(x, y) || (mask_at(mask, x - 1, y) && mask_at(mask, x + 1, y) &&
                             mask_at(mask, x, y - 1) && mask_at(mask, x, y + 1)))
        continue;
      glm::vec2 out(0);
      for (int dy = -kRadius; dy <= kRadius; ++dy)
        for (int dx = -kRadius; dx <= kRadius; ++dx)
          if (!mask_at(mask, x + dx, y + dy)) out += glm::vec2(dx, dy);
      all.push_back({from_mask({x, y}), std::atan2(out.y, out.x)});
    }
  const std::size_t step = std::max<std::size_t>(1, all.size() / kPoints);
  for (std::size_t i = 0; i < all.size(); i += step) outline_.push_back(all[i]);
}

glm::ivec2 Shape::cell_of(const glm::vec2& at) {
  const glm::vec2 cell = (at + kReach) * (kCells / (2 * kReach));
  return glm::clamp(glm::ivec2(cell), glm::ivec2(0), glm::ivec2(kCells - 1));
}

void Shape::find_distances() {
  for (int d = 0; d < kDirections; ++d) {
    distances_[static_cast<std::size_t>(d)] = Grid(kCells, kCells, kFarthest);
    auto& grid = distances_[static_cast<std::size_t>(d)];
    const float middle = (static_cast<float>(d) + 0.5f) * 2 * kPi / kDirections;
    for (const auto& [at, angle] : outline_)
      if (std::abs(std::remainder(angle - middle, 2 * kPi)) < 0.3f * kPi) {
        const auto cell = cell_of(at);
        grid.at(cell.x, cell.y) = 0;
      }
    spread(grid, 2 * kReach / kCells);
  }
}

float Shape::distance_at(const glm::vec2& at, float angle_rad) const {
  const float turns = angle_rad / (2 * kPi);
  const auto d = static_cast<std::size_t>((turns - std::floor(turns)) * kDirections);
  const auto cell = cell_of(at);
  return distances_[std::min<std::size_t>(d, kDirections - 1)].at(cell.x, cell.y);
}

float Shape::distance_of(const Shape& other, const Placement& placement) const {
  const float c = std::cos(placement.angle_rad), s = std::sin(placement.angle_rad);
  const float side = placement.is_mirrored ? -1.f : 1.f;
  float there = 0, back = 0;
  for (const auto& [at, angle] : other.outline_) {
    const glm::vec2 from(side * at.x, at.y);
    const glm::vec2 to =
        placement.scale * glm::vec2(c * from.x - s * from.y, s * from.x + c * from.y) +
        placement.shift;
    there += distance_at(to, (placement.is_mirrored ? kPi - angle : angle) + placement.angle_rad);
  }
  for (const auto& [at, angle] : outline_) {
    const glm::vec2 from = (at - placement.shift) / placement.scale;
    const glm::vec2 to(side * (c * from.x + s * from.y), -s * from.x + c * from.y);
    const float turned = angle - placement.angle_rad;
    back += other.distance_at(to, placement.is_mirrored ? kPi - turned : turned);
  }
  return 0.5f * (there / static_cast<float>(std::max<std::size_t>(1, other.outline_.size())) +
                 back / static_cast<float>(std::max<std::size_t>(1, outline_.size())));
}

float Shape::overlap_of(const Shape& other, const Placement& placement) const {
  const float c = std::cos(placement.angle_rad), s = std::sin(placement.angle_rad);
  const float side = placement.is_mirrored ? -1.f : 1.f;
  int both = 0, any = 0;
  for (int y = 0; y < kCells; ++y)
    for (int x = 0; x < kCells; ++x) {
      const glm::vec2 at = (glm::vec2(x, y) + 0.5f) * (2 * kReach / kCells) - kReach;
      const glm::vec2 from = (at - placement.shift) / placement.scale;
      const auto cell = cell_of({side * (c * from.x + s * from.y), -s * from.x + c * from.y});
      const int mine = area_.at(x, y), its = other.area_.at(cell.x, cell.y);
      both += mine & its;
      any += mine | its;
    }
  return any == 0 ? 0 : static_cast<float>(both) / static_cast<float>(any);
}

}  // namespace handcast::projegraphy
