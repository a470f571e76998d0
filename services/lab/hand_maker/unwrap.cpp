// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/unwrap.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "services/lab/hand_maker/cotangent.hpp"

namespace handcast::renderer {
namespace {

/// A triangle in its own plane, with the weights of the edges opposite its corners.
struct FlatTriangle {
  std::array<int, 3> vertex;
  std::array<glm::dvec2, 3> corner;
  std::array<double, 3> weight;
};

FlatTriangle laid_flat(const std::vector<glm::dvec3>& points, const std::array<int, 3>& t) {
  const glm::dvec3 a = points[t[1]] - points[t[0]], b = points[t[2]] - points[t[0]];
  const double length = glm::length(a);
  const glm::dvec3 x = a / length;
  const double along = glm::dot(b, x);
  return {t,
          {{{0, 0}, {length, 0}, {along, glm::length(b - x * along)}}},
          half_cotangents({points[t[0]], points[t[1]], points[t[2]]})};
}

/// The rotation (cosine, sine) that best maps the triangle's own edges to those of the chart.
glm::dvec2 best_rotation(const FlatTriangle& t, const std::vector<glm::dvec2>& flat) {
  glm::dvec2 sum(0);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const glm::dvec2 own = t.corner[i] - t.corner[j], now = flat[t.vertex[i]] - flat[t.vertex[j]];
    sum += t.weight[k] * glm::dvec2(glm::dot(own, now), own.x * now.y - own.y * now.x);
  }
  return sum / std::max(glm::length(sum), 1e-12);
}

Eigen::MatrixX2d right_hand_side(const std::vector<FlatTriangle>& triangles,
                                 const std::vector<glm::dvec2>& flat) {
  Eigen::MatrixX2d sum = Eigen::MatrixX2d::Zero(static_cast<Eigen::Index>(flat.size()), 2);
  for (const FlatTriangle& t : triangles) {
    const glm::dvec2 turn = best_rotation(t, flat);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const glm::dvec2 own = (t.corner[i] - t.corner[j]) * t.weight[k];
      const Eigen::RowVector2d turned(turn.x * own.x - turn.y * own.y,
                                      turn.y * own.x + turn.x * own.y);
      sum.row(t.vertex[i]) += turned;
      sum.row(t.vertex[j]) -= turned;
    }
  }
  return sum;
}

/// Flattens an open chart as rigidly as possible, in the scale of `points` (Liu et al. 2008, "A
/// Local/Global Approach to Mesh Parameterization", section 4). Each round computes the best
/// rotation of each triangle and then solves one linear system. `flat` holds the initial and the
/// resulting positions, by vertex.
void flatten_as_rigid_as_possible(const std::vector<glm::dvec3>& points,
                                  const std::vector<std::array<int, 3>>& triangles,
                                  std::vector<glm::dvec2>& flat, int rounds) {
  Eigen::SparseMatrix<double> system = mesh_operators(points, triangles).laplacian;
  system.coeffRef(0, 0) += 1;  // fixes the first vertex
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  std::vector<FlatTriangle> laid;
  laid.reserve(triangles.size());
  for (const auto& t : triangles) laid.push_back(laid_flat(points, t));
  for (int round = 0; round < rounds; ++round) {
    Eigen::MatrixX2d sums = right_hand_side(laid, flat);
    sums.row(0) += Eigen::RowVector2d(flat[0].x, flat[0].y);
    const Eigen::MatrixX2d solved = solver.solve(sums);
    for (std::size_t v = 0; v < flat.size(); ++v) flat[v] = {solved(v, 0), solved(v, 1)};
  }
}

constexpr double kGutter = 8.0 / 1024;  ///< share of the width of the atlas

struct Chart {
  std::vector<glm::dvec2> flat;  ///< millimetres, y down, the top left corner at the origin
  glm::dvec2 size{0};
};

/// Flattens the back or the palm. The initial positions are its vertices seen from outside, y up.
Chart chart_of(const SkinPoints& points, const GloveTemplate& glove,
               const std::vector<Triangle>& triangles, bool back) {
  std::vector<glm::dvec3> chart_points;
  Chart chart;
  for (int v = 0; v < glove.sheet_count(); ++v) {
    const glm::dvec3& p = points[back ? v : glove.glued_on_palm(v)];
    chart_points.push_back(p);
    chart.flat.emplace_back(back ? p.x : -p.x, -p.z);
  }
  flatten_as_rigid_as_possible(chart_points, triangles, chart.flat, 80);
  glm::dvec2 low = chart.flat.front(), high = low;
  for (const glm::dvec2& p : chart.flat) low = glm::min(low, p), high = glm::max(high, p);
  for (glm::dvec2& p : chart.flat) p = {p.x - low.x, high.y - p.y};
  chart.size = high - low;
  return chart;
}

}  // namespace

std::vector<glm::vec2> unwrapped(const SkinPoints& points, const GloveTemplate& glove,
                                 const std::vector<Triangle>& back,
                                 const std::vector<Triangle>& palm) {
  const Chart charts[2] = {chart_of(points, glove, back, true),
                           chart_of(points, glove, palm, false)};
  // The width in mm at which both charts fit, with a gutter around and between them.
  const double wide = (charts[0].size.x + charts[1].size.x) / (1 - 3 * kGutter);
  const double high =
      std::max(charts[0].size.y, charts[1].size.y) / (1 / kAtlasAspect - 2 * kGutter);
  const double width = std::max(wide, high), height = width / kAtlasAspect;
  const double spare = (width - charts[0].size.x - charts[1].size.x) / 3;
  std::vector<glm::vec2> uv;
  for (int k = 0; k < 2; ++k) {
    const glm::dvec2 corner{k == 0 ? spare : 2 * spare + charts[0].size.x,
                            (height - charts[k].size.y) / 2};
    for (const glm::dvec2& p : charts[k].flat)
      uv.emplace_back((corner + p) / glm::dvec2(width, height));
  }
  return uv;
}

}  // namespace handcast::renderer
