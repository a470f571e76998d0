// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "renderer/base/image.hpp"

/// How far a mask is from the true outline of a hand.
namespace handcast::renderer {

/// The agreement of two masks.
struct OutlineScore {
  double iou = 0;
  double p50_px = 0;  ///< distance of a boundary from the other one, of both boundaries together
  double p95_px = 0;
};

/// True inside the polygons (even-odd rule).
inline bool is_inside(std::span<const std::vector<glm::vec2>> polygons, glm::vec2 at) {
  bool inside = false;
  for (const auto& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if ((a.y > at.y) == (b.y > at.y)) continue;
      if (at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  return inside;
}

/// The pixels of `mask` with a neighbour that is not lit. `counts` leaves pixels out.
inline std::vector<glm::vec2> boundary_of(View<const std::uint8_t> mask,
                                          const std::function<bool(glm::vec2)>& counts) {
  std::vector<glm::vec2> pixels;
  for (int y = 1; y + 1 < mask.height; ++y)
    for (int x = 1; x + 1 < mask.width; ++x) {
      const bool inner =
          mask.at(x - 1, y) && mask.at(x + 1, y) && mask.at(x, y - 1) && mask.at(x, y + 1);
      if (mask.at(x, y) && !inner && counts({x, y})) pixels.emplace_back(x, y);
    }
  return pixels;
}

/// Appends the distance of each of `from` from the nearest of `to`.
inline void append_distances(const std::vector<glm::vec2>& from, const std::vector<glm::vec2>& to,
                             std::vector<double>& distances_px) {
  for (const glm::vec2& pixel : from) {
    float nearest = std::numeric_limits<float>::max();
    for (const glm::vec2& other : to) nearest = std::min(nearest, glm::distance(pixel, other));
    distances_px.push_back(nearest);
  }
}

/// Compares two masks of one size where `counts` is true.
inline OutlineScore score_outline(View<const std::uint8_t> mask, View<const std::uint8_t> truth,
                                  const std::function<bool(glm::vec2)>& counts) {
  int both = 0, either = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      if (!counts({x, y})) continue;
      both += mask.at(x, y) && truth.at(x, y);
      either += mask.at(x, y) || truth.at(x, y);
    }
  const auto found = boundary_of(mask, counts), real = boundary_of(truth, counts);
  std::vector<double> distances_px;
  append_distances(found, real, distances_px);
  append_distances(real, found, distances_px);
  if (either == 0 || distances_px.empty()) return {};
  std::sort(distances_px.begin(), distances_px.end());
  const auto at = [&](double share) {
    return distances_px[static_cast<std::size_t>(share * double(distances_px.size() - 1))];
  };
  return {static_cast<double>(both) / either, at(0.5), at(0.95)};
}

}  // namespace handcast::renderer
