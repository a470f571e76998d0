// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/foldover_repair.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace handcast::renderer {
namespace {

/// Twice an area that is not visible; also larger than rounding errors.
constexpr float kInvisible_px2 = 0.02f;
constexpr int kMostMoves = 200;  ///< of smooth(); then clusters are formed

/// Twice the signed area.
float area(std::span<const glm::vec2> px, const std::array<std::uint16_t, 3>& triangle) {
  const glm::vec2 a = px[triangle[1]] - px[triangle[0]], b = px[triangle[2]] - px[triangle[0]];
  return a.x * b.y - a.y * b.x;
}

}  // namespace

FoldoverRepair::FoldoverRepair(const HandMesh& mesh) : triangles_(mesh.triangles) {
  std::map<std::array<float, 3>, std::uint16_t> places;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const glm::vec3& at = mesh.positions[v];
    const auto [place, is_new] =
        places.emplace(std::array{at.x, at.y, at.z}, static_cast<std::uint16_t>(at_place_.size()));
    if (is_new) at_place_.emplace_back();
    place_of_.push_back(place->second);
    at_place_[place->second].push_back(static_cast<std::uint16_t>(v));
  }
  around_.resize(at_place_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const std::uint16_t v : triangles_[t])
      around_[place_of_[v]].push_back(static_cast<std::uint32_t>(t));
  clusters_.resize(at_place_.size());
  std::size_t most_around = 0;
  for (const auto& around : around_) most_around = std::max(most_around, around.size());
  waiting_.resize(triangles_.size() + 3 * kMostMoves * most_around);  // nothing grows in a frame
}

bool FoldoverRepair::turned_over(std::size_t triangle, std::span<const glm::vec2> before,
                                 std::span<const glm::vec2> after, float facing_sign) const {
  return area(before, triangles_[triangle]) * facing_sign > 0 &&
         area(after, triangles_[triangle]) * facing_sign < -kInvisible_px2;
}

/// Makes each place a cluster.
void FoldoverRepair::start(std::span<const glm::vec2> before, std::span<const glm::vec2> after) {
  for (std::size_t place = 0; place < at_place_.size(); ++place) {
    const std::uint16_t v = at_place_[place].front();
    clusters_[place] = {static_cast<std::uint16_t>(place), after[v] - before[v], 1};
  }
}

std::uint16_t FoldoverRepair::root_of(std::uint16_t place) {
  while (clusters_[place].parent != place)
    place = clusters_[place].parent = clusters_[clusters_[place].parent].parent;
  return place;
}

/// Joins the clusters of the corners. Returns false if they are one already.
bool FoldoverRepair::join(const Triangle& triangle) {
  const std::uint16_t root = root_of(place_of_[triangle[0]]);
  bool has_grown = false;
  for (const std::uint16_t v : {triangle[1], triangle[2]}) {
    const std::uint16_t other = root_of(place_of_[v]);
    if (other == root) continue;
    clusters_[other].parent = root;
    clusters_[root].moved += clusters_[other].moved;
    clusters_[root].count += clusters_[other].count;
    has_grown = true;
  }
  return has_grown;
}

/// Gives the places of each cluster its mean displacement.
void FoldoverRepair::move_clusters(std::span<const glm::vec2> before, std::span<glm::vec2> after) {
  for (std::size_t place = 0; place < at_place_.size(); ++place) {
    const Cluster& cluster = clusters_[root_of(static_cast<std::uint16_t>(place))];
    if (cluster.count < 2) continue;
    const glm::vec2 moved = cluster.moved / cluster.count;
    for (const std::uint16_t v : at_place_[place]) after[v] = before[v] + moved;
  }
}

/// Gives the corners of each turned-over triangle their mean displacement and examines its
/// neighbours again. Returns true if nothing remains turned over.
bool FoldoverRepair::smooth(std::span<const glm::vec2> before, std::span<glm::vec2> after,
                            float facing_sign) {
  int moves = 0;
  for (std::size_t next = 0; next < waiting_.size(); ++next) {
    if (!turned_over(waiting_[next], before, after, facing_sign)) continue;
    if (++moves > kMostMoves) return false;
    const Triangle& triangle = triangles_[waiting_[next]];
    glm::vec2 moved{0};
    for (const std::uint16_t v : triangle) moved += (after[v] - before[v]) / 3.0f;
    for (const std::uint16_t corner : triangle) {
      const std::uint16_t place = place_of_[corner];
      for (const std::uint16_t v : at_place_[place]) after[v] = before[v] + moved;
      waiting_.insert(waiting_.end(), around_[place].begin(), around_[place].end());
    }
  }
  return true;
}

int FoldoverRepair::count(std::span<const glm::vec2> before, std::span<const glm::vec2> after,
                          float facing_sign) const {
  int turned_over_count = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    turned_over_count += turned_over(t, before, after, facing_sign);
  return turned_over_count;
}

void FoldoverRepair::find_turned_over(std::span<const glm::vec2> before,
                                      std::span<const glm::vec2> after, float facing_sign) {
  waiting_.clear();
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (turned_over(t, before, after, facing_sign))
      waiting_.push_back(static_cast<std::uint32_t>(t));
}

/// The triangles that face the camera.
void FoldoverRepair::find_facing(std::span<const glm::vec2> before, float facing_sign) {
  waiting_.clear();
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (area(before, triangles_[t]) * facing_sign > 0)
      waiting_.push_back(static_cast<std::uint32_t>(t));
}

int FoldoverRepair::repair(std::span<const glm::vec2> before, std::span<glm::vec2> after,
                           float facing_sign) {
  find_turned_over(before, after, facing_sign);
  if (smooth(before, after, facing_sign)) return 0;
  start(before, after);
  find_facing(before, facing_sign);
  const auto at = [&](std::uint16_t v) {
    const Cluster& cluster = clusters_[root_of(place_of_[v])];
    return cluster.count > 1 ? before[v] + cluster.moved / cluster.count : after[v];
  };
  // Each round but the last joins clusters, so there are fewer rounds than places. Positions follow
  // from the clusters; to write them after each join would take the time of the square of a
  // cluster's size.
  for (bool has_grown = true; has_grown;) {
    has_grown = false;
    for (const std::uint32_t t : waiting_) {
      const Triangle& triangle = triangles_[t];
      const std::array corners{at(triangle[0]), at(triangle[1]), at(triangle[2])};
      if (area(corners, {0, 1, 2}) * facing_sign < -kInvisible_px2)
        has_grown = join(triangle) || has_grown;
    }
  }
  move_clusters(before, after);
  find_turned_over(before, after, facing_sign);
  return static_cast<int>(waiting_.size());
}

}  // namespace handcast::renderer
