// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/surface_nets.hpp"

#include <algorithm>

namespace handcast::twin {
namespace {

using Cell = glm::ivec3;

/// The samples of a field at the nodes of a grid.
class Grid {
 public:
  Grid(const Field& field, const glm::dvec3& low, const glm::dvec3& high, double step)
      : low_(low), step_(step), nodes_(glm::ivec3(glm::ceil((high - low) / step)) + 1) {
    values_.reserve(static_cast<std::size_t>(nodes_.x) * nodes_.y * nodes_.z);
    for (int z = 0; z < nodes_.z; ++z)
      for (int y = 0; y < nodes_.y; ++y)
        for (int x = 0; x < nodes_.x; ++x) values_.push_back(field(place({x, y, z})));
  }

  const glm::ivec3& nodes() const { return nodes_; }
  std::size_t index(const Cell& node) const {
    return (static_cast<std::size_t>(node.z) * nodes_.y + node.y) * nodes_.x + node.x;
  }
  glm::dvec3 place(const Cell& node) const { return low_ + glm::dvec3(node) * step_; }
  double value(const Cell& node) const { return values_[index(node)]; }
  bool crosses(const Cell& a, const Cell& b) const { return (value(a) < 0) != (value(b) < 0); }
  /// The point of the surface on the edge between two nodes that it crosses.
  glm::dvec3 crossing(const Cell& a, const Cell& b) const {
    return glm::mix(place(a), place(b), value(a) / (value(a) - value(b)));
  }

 private:
  glm::dvec3 low_;
  double step_;
  glm::ivec3 nodes_;
  std::vector<double> values_;
};

Cell unit(int axis) {
  Cell step(0);
  step[axis] = 1;
  return step;
}

template <class Visit>
void for_each_node(const glm::ivec3& nodes, int first, const Visit& visit) {
  for (int z = first; z + 1 < nodes.z; ++z)
    for (int y = first; y + 1 < nodes.y; ++y)
      for (int x = first; x + 1 < nodes.x; ++x) visit(Cell(x, y, z));
}

/// The mean of the crossings of a cell's edges; `count` is their number.
glm::dvec3 middle_of(const Grid& grid, const Cell& cell, int& count) {
  glm::dvec3 sum(0);
  count = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      const Cell from =
          cell + (corner & 1) * unit((axis + 1) % 3) + (corner >> 1) * unit((axis + 2) % 3);
      if (!grid.crosses(from, from + unit(axis))) continue;
      sum += grid.crossing(from, from + unit(axis));
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : sum;
}

/// Adds a quadrilateral, cut along its shorter diagonal.
void add_quad(NetSurface& surface, const std::array<std::uint16_t, 4>& q) {
  const auto far = [&](int a, int b) {
    return glm::distance(surface.points[q[a]], surface.points[q[b]]);
  };
  if (far(0, 2) <= far(1, 3)) {
    surface.triangles.push_back({q[0], q[1], q[2]});
    surface.triangles.push_back({q[0], q[2], q[3]});
  } else {
    surface.triangles.push_back({q[1], q[2], q[3]});
    surface.triangles.push_back({q[1], q[3], q[0]});
  }
}

void put_onto(const Field& field, double longest, glm::dvec3& point) {
  const glm::dvec3 slope = gradient_of(field, point);
  const double squared = std::max(glm::dot(slope, slope), 0.25);
  point -= slope * std::clamp(field(point) / squared, -longest, longest);
}

/// Moves each point half of the way to the mean of its neighbours, and back onto the surface.
void even_out(const Field& field, double step, NetSurface& surface) {
  std::vector<glm::dvec3> sums(surface.points.size(), glm::dvec3(0));
  std::vector<double> counts(surface.points.size(), 0);
  for (const auto& triangle : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      sums[triangle[k]] += surface.points[triangle[(k + 1) % 3]];
      ++counts[triangle[k]];
    }
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    surface.points[v] = glm::mix(surface.points[v], sums[v] / counts[v], 0.5);
    put_onto(field, step, surface.points[v]);
  }
}

}  // namespace

glm::dvec3 gradient_of(const Field& field, const glm::dvec3& point) {
  constexpr double kStep = 0.05;
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 step = kStep * glm::dvec3(unit(axis));
    gradient[axis] = (field(point + step) - field(point - step)) / (2 * kStep);
  }
  return gradient;
}

NetSurface surface_net(const Field& field, const glm::dvec3& low, const glm::dvec3& high,
                       double step) {
  const Grid grid(field, low, high, step);
  NetSurface surface;
  std::vector<std::uint16_t> point_in(
      static_cast<std::size_t>(grid.nodes().x) * grid.nodes().y * grid.nodes().z, 0);
  for_each_node(grid.nodes(), 0, [&](const Cell& cell) {
    int count = 0;
    const glm::dvec3 middle = middle_of(grid, cell, count);
    if (count == 0) return;
    point_in[grid.index(cell)] = static_cast<std::uint16_t>(surface.points.size());
    surface.points.push_back(middle);
  });
  for_each_node(grid.nodes(), 1, [&](const Cell& node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!grid.crosses(node, node + unit(axis))) continue;
      const Cell u = unit((axis + 1) % 3), v = unit((axis + 2) % 3);
      std::array<std::uint16_t, 4> quad{point_in[grid.index(node)], point_in[grid.index(node - u)],
                                        point_in[grid.index(node - u - v)],
                                        point_in[grid.index(node - v)]};
      if (grid.value(node) >= 0) std::reverse(quad.begin(), quad.end());
      add_quad(surface, quad);
    }
  });
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) even_out(field, step, surface);
  return surface;
}

}  // namespace handcast::twin
