// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace handcast::twin {

/// A surface of triangles that are counter-clockwise seen from outside.
struct NetSurface {
  std::vector<glm::dvec3> points;
  std::vector<std::array<std::uint16_t, 3>> triangles;
};

/// A function that is negative inside a shape and about the distance to it outside.
using Field = std::function<double(const glm::dvec3&)>;

/// The surface at which `field` is 0, by naive surface nets (Gibson 1998, "Constrained Elastic
/// Surface Nets"): one point in each cell of a grid that the surface crosses, joined across each
/// edge of the grid that it crosses. The points are then evened out and put onto the surface. The
/// shape must lie inside the box and have fewer than 65,536 points.
NetSurface surface_net(const Field& field, const glm::dvec3& low, const glm::dvec3& high,
                       double step);

/// The gradient of a field.
glm::dvec3 gradient_of(const Field& field, const glm::dvec3& point);

}  // namespace handcast::twin
