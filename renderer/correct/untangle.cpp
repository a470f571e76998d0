// SPDX-License-Identifier: Apache-2.0
#include "renderer/correct/untangle.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

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

Untangler::Untangler(const HandMesh& mesh) : triangles_(mesh.triangles) {
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
}

bool Untangler::turned_over(std::size_t triangle, std::span<const glm::vec2> before,
                            std::span<const glm::vec2> after, float facing_sign) const {
  return area(before, triangles_[triangle]) * facing_sign > 0 &&
         area(after, triangles_[triangle]) * facing_sign < -kInvisible_px2;
}

void Untangler::shift(std::uint16_t place, const glm::vec2& moved,
                      std::span<const glm::vec2> before, std::span<glm::vec2> after) {
  for (const std::uint16_t v : at_place_[place]) after[v] = before[v] + moved;
  waiting_.insert(waiting_.end(), around_[place].begin(), around_[place].end());
}

/// Makes each place a cluster.
void Untangler::start(std::span<const glm::vec2> before, std::span<const glm::vec2> after) {
  clusters_.resize(at_place_.size());
  for (std::size_t place = 0; place < at_place_.size(); ++place) {
    const std::uint16_t v = at_place_[place].front();
    const auto self = static_cast<std::uint16_t>(place);
    clusters_[place] = {self, self, after[v] - before[v], 1};
  }
}

std::uint16_t Untangler::root_of(std::uint16_t place) {
  while (clusters_[place].parent != place)
    place = clusters_[place].parent = clusters_[clusters_[place].parent].parent;
  return place;
}

bool Untangler::is_joined(const Triangle& triangle) {
  const std::uint16_t root = root_of(place_of_[triangle[0]]);
  return root_of(place_of_[triangle[1]]) == root && root_of(place_of_[triangle[2]]) == root;
}

std::uint16_t Untangler::join(const Triangle& triangle) {
  std::uint16_t root = root_of(place_of_[triangle[0]]);
  for (const std::uint16_t v : {triangle[1], triangle[2]}) {
    const std::uint16_t other = root_of(place_of_[v]);
    if (other == root) continue;
    clusters_[other].parent = root;
    std::swap(clusters_[other].next, clusters_[root].next);  // two rings become one
    clusters_[root].moved += clusters_[other].moved;
    clusters_[root].count += clusters_[other].count;
  }
  return root;
}

void Untangler::move(std::uint16_t root, std::span<const glm::vec2> before,
                     std::span<glm::vec2> after) {
  const glm::vec2 moved = clusters_[root].moved / clusters_[root].count;
  std::uint16_t place = root;
  do {
    shift(place, moved, before, after);
    place = clusters_[place].next;
  } while (place != root);
}

/// Gives the corners of each turned-over triangle their mean displacement and examines its
/// neighbours again. Returns true if nothing remains turned over.
bool Untangler::smooth(std::span<const glm::vec2> before, std::span<glm::vec2> after,
                       float facing_sign) {
  int moves = 0;
  for (std::size_t next = 0; next < waiting_.size(); ++next) {
    if (!turned_over(waiting_[next], before, after, facing_sign)) continue;
    if (++moves > kMostMoves) return false;
    const Triangle& triangle = triangles_[waiting_[next]];
    glm::vec2 moved{0};
    for (const std::uint16_t v : triangle) moved += (after[v] - before[v]) / 3.0f;
    for (const std::uint16_t v : triangle) shift(place_of_[v], moved, before, after);
  }
  return true;
}

int Untangler::count(std::span<const glm::vec2> before, std::span<const glm::vec2> after,
                     float facing_sign) const {
  int turned_over_count = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    turned_over_count += turned_over(t, before, after, facing_sign);
  return turned_over_count;
}

void Untangler::find_turned_over(std::span<const glm::vec2> before,
                                 std::span<const glm::vec2> after, float facing_sign) {
  waiting_.clear();
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (turned_over(t, before, after, facing_sign))
      waiting_.push_back(static_cast<std::uint32_t>(t));
}

int Untangler::untangle(std::span<const glm::vec2> before, std::span<glm::vec2> after,
                        float facing_sign) {
  find_turned_over(before, after, facing_sign);
  if (smooth(before, after, facing_sign)) return 0;
  find_turned_over(before, after, facing_sign);
  start(before, after);
  // Each turn of the loop that appends joins two clusters, so there are fewer than there are
  // places.
  for (std::size_t next = 0; next < waiting_.size(); ++next) {
    const Triangle& triangle = triangles_[waiting_[next]];
    if (turned_over(waiting_[next], before, after, facing_sign) && !is_joined(triangle))
      move(join(triangle), before, after);
  }
  find_turned_over(before, after, facing_sign);
  return static_cast<int>(waiting_.size());
}

}  // namespace handcast::renderer
