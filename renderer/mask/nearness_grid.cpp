// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/nearness_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace handcast::renderer {
namespace {

constexpr float kUnset = -std::numeric_limits<float>::infinity();

}  // namespace

NearnessGrid::NearnessGrid(int columns, int rows, int step_px)
    : columns_(columns),
      rows_(rows),
      step_px_(step_px),
      points_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

void NearnessGrid::set(std::span<const glm::vec2> projected_px, std::span<const float> depths_m,
                       double plane_m) {
  std::ranges::fill(points_, kUnset);
  const auto plane_nearness = static_cast<float>(1 / plane_m);
  for (std::size_t v = 0; v < projected_px.size(); ++v) {
    const auto at = glm::round(projected_px[v] / static_cast<float>(step_px_));
    if (!(at.x >= 0 && at.y >= 0 && at.x < static_cast<float>(columns_) &&
          at.y < static_cast<float>(rows_)))
      continue;
    float& point = points_[static_cast<std::size_t>(at.y) * static_cast<std::size_t>(columns_) +
                           static_cast<std::size_t>(at.x)];
    point = std::max(point, 1 / depths_m[v] - plane_nearness);
  }
  spread();
}

/// Two passes, down and up, each from the neighbours before (Rosenfeld & Pfaltz 1966).
void NearnessGrid::spread() {
  const auto columns = static_cast<std::size_t>(columns_);
  least_ = std::numeric_limits<float>::infinity();
  most_ = kUnset;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_[i] == kUnset && i % columns > 0) points_[i] = points_[i - 1];
    if (points_[i] == kUnset && i >= columns) points_[i] = points_[i - columns];
  }
  for (std::size_t i = points_.size(); i-- > 0;) {
    if (points_[i] == kUnset && i % columns + 1 < columns) points_[i] = points_[i + 1];
    if (points_[i] == kUnset && i + columns < points_.size()) points_[i] = points_[i + columns];
    if (points_[i] == kUnset) points_[i] = 0;  // no vertex lands on the screen
    least_ = std::min(least_, points_[i]);
    most_ = std::max(most_, points_[i]);
  }
}

}  // namespace handcast::renderer
