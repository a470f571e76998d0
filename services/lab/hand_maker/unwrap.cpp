// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/unwrap.hpp"

#include <algorithm>

#include "services/lab/hand_maker/arap.hpp"

namespace handcast::renderer {
namespace {

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
