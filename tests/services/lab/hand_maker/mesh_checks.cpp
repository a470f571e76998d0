// SPDX-License-Identifier: Apache-2.0
#include "tests/services/lab/hand_maker/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace handcast::renderer::samples {

const HandMesh& mean_hand(Side side) {
  static const HandMesh left = make_hand(HandShape::mean(), Side::left),
                        right = make_hand(HandShape::mean(), Side::right);
  return side == Side::left ? left : right;
}

HandShape another_person() {
  return HandShape::mean().scaled({1.04f, 1.07f, 1.05f, 1.08f, 1.03f}, 1.04f, 0.94f);
}

std::vector<int> welded(const HandMesh& hand) {
  std::map<std::tuple<float, float, float>, int> first;
  std::vector<int> same;
  for (int v = 0; v < std::ssize(hand.positions); ++v) {
    const glm::vec3& p = hand.positions[v];
    same.push_back(first.try_emplace({p.x, p.y, p.z}, v).first->second);
  }
  return same;
}

int open_edges(const HandMesh& hand) {
  const auto same = welded(hand);
  std::map<std::pair<int, int>, std::pair<int, int>>
      uses;  // lower, higher vertex -> times walked up, down
  for (const auto& t : hand.triangles)
    for (int c = 0; c < 3; ++c) {
      const int a = same[t[c]], b = same[t[(c + 1) % 3]];
      auto& [up, down] = uses[std::minmax(a, b)];
      ++(a < b ? up : down);
    }
  return static_cast<int>(std::count_if(uses.begin(), uses.end(), [](const auto& use) {
    return use.second != std::pair{1, 1};
  }));
}

int least_valence(const HandMesh& hand) {
  const auto same = welded(hand);
  std::map<int, std::set<int>> neighbours;
  for (const auto& t : hand.triangles)
    for (int c = 0; c < 3; ++c) {
      neighbours[same[t[c]]].insert(same[t[(c + 1) % 3]]);
      neighbours[same[t[c]]].insert(same[t[(c + 2) % 3]]);
    }
  std::size_t least = 1000;
  for (const auto& [vertex, around] : neighbours) least = std::min(least, around.size());
  return static_cast<int>(least);
}

namespace {

using Corners = std::array<glm::dvec3, 3>;

double signed_volume(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                     const glm::dvec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

/// Whether the segment passes through the triangle's inside.
bool pierces(const glm::dvec3& from, const glm::dvec3& to, const Corners& t) {
  if (signed_volume(t[0], t[1], t[2], from) * signed_volume(t[0], t[1], t[2], to) >= 0)
    return false;
  const double a = signed_volume(from, to, t[0], t[1]), b = signed_volume(from, to, t[1], t[2]),
               c = signed_volume(from, to, t[2], t[0]);
  return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

bool cut(const Corners& a, const Corners& b) {
  for (int k = 0; k < 3; ++k)
    if (pierces(a[k], a[(k + 1) % 3], b) || pierces(b[k], b[(k + 1) % 3], a)) return true;
  return false;
}

}  // namespace

int self_intersections(const HandMesh& hand, const std::vector<glm::vec3>& positions) {
  struct Box {
    glm::dvec3 low, high;
    Corners corners;
    std::array<int, 3> vertices;
  };
  const auto same = welded(hand);
  std::vector<Box> boxes;
  for (const auto& t : hand.triangles) {
    const Corners c{positions[t[0]], positions[t[1]], positions[t[2]]};
    boxes.push_back({glm::min(glm::min(c[0], c[1]), c[2]),
                     glm::max(glm::max(c[0], c[1]), c[2]),
                     c,
                     {same[t[0]], same[t[1]], same[t[2]]}});
  }
  std::sort(boxes.begin(), boxes.end(),
            [](const Box& a, const Box& b) { return a.low.z < b.low.z; });
  int count = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size() && boxes[j].low.z <= boxes[i].high.z; ++j) {
      const Box &a = boxes[i], &b = boxes[j];
      if (a.low.x > b.high.x || b.low.x > a.high.x || a.low.y > b.high.y || b.low.y > a.high.y)
        continue;
      const bool touch =
          std::find_first_of(a.vertices.begin(), a.vertices.end(), b.vertices.begin(),
                             b.vertices.end()) != a.vertices.end();
      count += !touch && cut(a.corners, b.corners);
    }
  return count;
}

int flips(const HandMesh& hand) {
  int count = 0;
  for (const auto& t : hand.triangles) {
    const glm::vec3& a = hand.positions[t[0]];
    const glm::vec3 front = glm::cross(hand.positions[t[1]] - a, hand.positions[t[2]] - a);
    count += glm::dot(front, hand.normals[t[0]] + hand.normals[t[1]] + hand.normals[t[2]]) <= 0;
  }
  return count;
}

double volume_m3(const HandMesh& hand, const std::vector<glm::vec3>& positions) {
  double six_times = 0;
  for (const auto& t : hand.triangles)
    six_times += glm::dot(glm::dvec3(positions[t[0]]),
                          glm::cross(glm::dvec3(positions[t[1]]), glm::dvec3(positions[t[2]])));
  return six_times / 6;
}

std::vector<double> stretch_ratios(const HandMesh& hand) {
  std::vector<double> ratios;
  for (const auto& t : hand.triangles) {
    const glm::dvec3 a = hand.positions[t[1]] - hand.positions[t[0]],
                     b = hand.positions[t[2]] - hand.positions[t[0]];
    const glm::dvec2 atlas(kAtlasAspect, 1);
    const glm::dvec2 u = atlas * glm::dvec2(hand.uv[t[1]] - hand.uv[t[0]]),
                     v = atlas * glm::dvec2(hand.uv[t[2]] - hand.uv[t[0]]);
    const double length = glm::length(a), along = glm::dot(a, b) / length,
                 off = glm::length(glm::cross(a, b)) / length;
    const glm::dmat2 jacobian = glm::dmat2(u, v) * glm::inverse(glm::dmat2(length, 0, along, off));
    const double half_sum =
        (glm::dot(jacobian[0], jacobian[0]) + glm::dot(jacobian[1], jacobian[1])) / 2;
    const double root =
        std::sqrt(std::max(0.0, half_sum * half_sum - std::pow(glm::determinant(jacobian), 2)));
    ratios.push_back(std::sqrt((half_sum + root) / (half_sum - root)));
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios;
}

int uv_overlaps(const HandMesh& hand) {
  constexpr int kWidth = 4096, kHeight = 2560;
  std::vector<char> taken(static_cast<std::size_t>(kWidth) * kHeight, 0);
  int overlaps = 0;
  for (const auto& t : hand.triangles) {
    glm::dvec2 p[3];
    for (int c = 0; c < 3; ++c) p[c] = glm::dvec2(hand.uv[t[c]]) * glm::dvec2(kWidth, kHeight);
    const double area =
        (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y});
    for (int y = std::max(0, int(y0)); y <= std::min(kHeight - 1, int(y1) + 1); ++y)
      for (int x = std::max(0, int(x0)); x <= std::min(kWidth - 1, int(x1) + 1); ++x) {
        bool inside = true;
        for (int c = 0; c < 3; ++c) {
          const glm::dvec2 &u = p[(c + 1) % 3], &w = p[(c + 2) % 3];
          inside &= ((w.x - u.x) * (y - u.y) - (x - u.x) * (w.y - u.y)) / area > 1e-6;
        }
        if (inside) overlaps += taken[static_cast<std::size_t>(y) * kWidth + x]++ > 0;
      }
  }
  return overlaps;
}

double percentile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * (sorted.size() - 1))];
}

}  // namespace handcast::renderer::samples
