// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/solid.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace handcast::twin {
namespace {

constexpr int kRings = 18, kSpokes = 24;

}  // namespace

Solid make_ellipsoid(const glm::vec3& middle, const glm::vec3& half_axes) {
  Solid solid;
  for (int ring = 0; ring <= kRings; ++ring)
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double down = std::numbers::pi * ring / kRings,
                   around = 2 * std::numbers::pi * spoke / kSpokes;
      const glm::vec3 ball(std::sin(down) * std::cos(around), -std::cos(down),
                           std::sin(down) * std::sin(around));
      solid.positions.push_back(middle + ball * half_axes);
      solid.normals.push_back(glm::normalize(ball / half_axes));
    }
  const auto at = [](int ring, int spoke) {
    return static_cast<std::uint16_t>(ring * kSpokes + spoke % kSpokes);
  };
  for (int ring = 0; ring < kRings; ++ring)
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      solid.triangles.push_back({at(ring, spoke), at(ring + 1, spoke), at(ring, spoke + 1)});
      solid.triangles.push_back(
          {at(ring, spoke + 1), at(ring + 1, spoke), at(ring + 1, spoke + 1)});
    }
  return solid;
}

Solid make_reflector(double diameter_m) {
  return make_ellipsoid(glm::vec3(0), glm::vec3(static_cast<float>(diameter_m / 2)));
}

Solid make_held_object() {
  // The palm joint's y axis leaves the back of the hand; the fingers close around the object.
  const glm::vec3 before_palm_m(0, -0.040f, -0.030f), half_axes_m(0.075f, 0.025f, 0.025f);
  return make_ellipsoid(before_palm_m, half_axes_m);
}

void mirror_in_table(std::span<glm::vec3> positions, std::span<glm::vec3> normals) {
  const glm::vec3 point(0, 0, 0.88f), normal = glm::normalize(glm::vec3(0, 0.17f, -1));
  for (std::size_t v = 0; v < positions.size(); ++v) {
    positions[v] -= 2 * glm::dot(positions[v] - point, normal) * normal;
    normals[v] -= 2 * glm::dot(normals[v], normal) * normal;
  }
}

}  // namespace handcast::twin
