// SPDX-License-Identifier: Apache-2.0
#include "calib/solve/screen/gray_patch.hpp"

#include <algorithm>
#include <cmath>

namespace handcast::calib {

static constexpr int kLeastEdges = 12;  ///< of columns, and of rows

std::optional<PatchReading> read_patch(const Patch& patch, const glm::dvec2& first_px) {
  const auto& [column, row] = patch;
  if (std::min(column.count, row.count) < kLeastEdges) return {};
  const auto across = glm::inverse(column.normal) * column.right;
  const auto down = glm::inverse(row.normal) * row.right;
  const auto sums = column.normal[2] + row.normal[2];  // of the weights times x, y, 1
  const auto centre = sums / sums.z;
  // Projector pixels per camera pixel.
  const double scale = std::sqrt(std::abs(across.x * down.y - across.y * down.x));
  const double squares =
      column.square - glm::dot(across, column.right) + row.square - glm::dot(down, row.right);
  const int edges = column.count + row.count;
  PatchReading reading;
  reading.misfit = std::sqrt(std::max(squares, 0.) / (edges - 6)) / scale;
  reading.rms_px = reading.misfit * std::sqrt(edges / sums.z);
  if (!std::isfinite(reading.misfit)) return {};
  reading.point = {first_px + glm::dvec2(centre),
                   {glm::dot(across, centre), glm::dot(down, centre)},
                   scale / std::sqrt(std::min(column.normal[2].z, row.normal[2].z))};
  return reading;
}

}  // namespace handcast::calib
