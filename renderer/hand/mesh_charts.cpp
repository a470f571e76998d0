// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/mesh_charts.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace handcast::renderer {
namespace {

constexpr int kMaxCharts = 60;

/// Union-find. The root of a set is its lowest member, so charts are numbered in vertex order.
class Parts {
 public:
  explicit Parts(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::size_t root(std::size_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t ra = root(a), rb = root(b);
    parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

void number_charts(HandMesh& hand) {
  Parts parts(hand.vertex_count());
  for (const auto& t : hand.triangles) {
    parts.join(t[0], t[1]);
    parts.join(t[0], t[2]);
  }
  std::map<std::array<float, 5>, std::size_t> seen;
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    const glm::vec3& p = hand.positions[v];
    const auto [first, is_new] = seen.try_emplace({p.x, p.y, p.z, hand.uv[v].x, hand.uv[v].y}, v);
    if (!is_new) parts.join(first->second, v);
  }
  std::map<std::size_t, int> number;
  hand.chart.resize(hand.vertex_count());
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    const int next = std::min<int>(static_cast<int>(number.size()) + 1, kMaxCharts);
    hand.chart[v] =
        static_cast<std::uint8_t>(number.try_emplace(parts.root(v), next).first->second);
  }
}

}  // namespace handcast::renderer
