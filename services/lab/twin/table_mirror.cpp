// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/table_mirror.hpp"

#include <cstddef>

namespace handcast::twin {

void mirror_in_table(std::span<glm::vec3> positions, std::span<glm::vec3> normals) {
  const glm::vec3 point(0, 0, 0.88f), normal = glm::normalize(glm::vec3(0, 0.17f, -1));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    positions[v] -= 2 * glm::dot(positions[v] - point, normal) * normal;
    normals[v] -= 2 * glm::dot(normals[v], normal) * normal;
  }
}

}  // namespace handcast::twin
