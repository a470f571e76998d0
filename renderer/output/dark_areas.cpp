// SPDX-License-Identifier: Apache-2.0
#include "renderer/output/dark_areas.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::renderer {
namespace {

/// Where the edges of a polygon cross the middle of a row, from left to right.
std::vector<double> crossings(const config::Polygon& corners, double y) {
  std::vector<double> all;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto &a = corners[i], &b = corners[(i + 1) % corners.size()];
    if ((a[1] <= y) == (b[1] <= y)) continue;
    all.push_back(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
  }
  std::ranges::sort(all);
  return all;
}

/// Adds a row's span; makes one of the row above longer if it is the same.
void add(Rect span, std::size_t begin, std::vector<Rect>& rects) {
  if (span.empty()) return;
  for (std::size_t i = begin; i < rects.size(); ++i)
    if (rects[i].x0 == span.x0 && rects[i].x1 == span.x1 && rects[i].y1 == span.y0) {
      rects[i].y1 = span.y1;
      return;
    }
  rects.push_back(span);
}

}  // namespace

std::vector<Rect> dark_areas(std::span<const config::Polygon> areas, int width_px, int height_px) {
  std::vector<Rect> rects;
  const auto column = [width_px](double x) {
    return static_cast<int>(std::clamp(x, 0., static_cast<double>(width_px)));
  };
  for (const auto& corners : areas) {
    const std::size_t begin = rects.size();
    for (int y = 0; y < height_px; ++y) {
      const auto across = crossings(corners, y + 0.5);
      for (std::size_t i = 0; i + 1 < across.size(); i += 2)
        add({column(std::floor(across[i])), y, column(std::ceil(across[i + 1])), y + 1}, begin,
            rects);
    }
  }
  return rects;
}

}  // namespace handcast::renderer
