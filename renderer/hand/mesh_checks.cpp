// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace handcast::renderer {
namespace {

std::string fault_of_size(const HandMesh& hand) {
  constexpr float kFarthest_m = 1, kShortest_m = 0.02f;
  constexpr std::size_t kRootJoint = 1;
  const glm::vec3 wrist(hand.rest[kRootJoint][3]);
  float farthest_m = 0;
  for (const auto& joint : hand.rest)
    farthest_m = std::max(farthest_m, glm::length(glm::vec3(joint[3]) - wrist));
  for (const auto& position : hand.positions)
    farthest_m = std::max(farthest_m, glm::length(position - wrist));
  if (farthest_m < kFarthest_m && farthest_m > kShortest_m) return {};
  return fmt::format(
      "its mesh reaches {:.3g} m from the wrist; a hand in metres reaches {} to {} m", farthest_m,
      kShortest_m, kFarthest_m);
}

/// A hand has a surface of 0.05 m2, and 65,534 triangles on it have edges of 100 m.
std::string fault_of_surface(const HandMesh& hand) {
  constexpr double kMostArea_m2 = 1, kMostEdges_m = 500;
  double area_m2 = 0, edges_m = 0;
  for (const auto& t : hand.triangles) {
    const glm::vec3 &a = hand.positions[t[0]], &b = hand.positions[t[1]], &c = hand.positions[t[2]];
    area_m2 += 0.5 * glm::length(glm::cross(b - a, c - a));
    edges_m += std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  }
  if (area_m2 > kMostArea_m2)
    return fmt::format("its triangles have an area of {:.3g} m2; at most {} m2 are possible",
                       area_m2, kMostArea_m2);
  if (edges_m > kMostEdges_m)
    return fmt::format("its triangles have edges of {:.3g} m in all; at most {} m are possible",
                       edges_m, kMostEdges_m);
  return {};
}

/// Texture coordinates may repeat the texture, and charts may share a part of it.
std::string fault_of_texture(const HandMesh& hand) {
  constexpr float kFarthest = 16;
  constexpr double kMostLayers = 64;
  for (const glm::vec2& uv : hand.uv)
    if (!(glm::abs(uv.x) <= kFarthest && glm::abs(uv.y) <= kFarthest))
      return fmt::format("its texture coordinates contain ({:.3g}, {:.3g}); {} to {} are possible",
                         uv.x, uv.y, -kFarthest, kFarthest);
  double layers = 0;  // boxes of the triangles, in areas of the texture
  for (const auto& t : hand.triangles) {
    const glm::vec2 &a = hand.uv[t[0]], &b = hand.uv[t[1]], &c = hand.uv[t[2]];
    const auto low = glm::clamp(glm::min(a, glm::min(b, c)), 0.f, 1.f),
               high = glm::clamp(glm::max(a, glm::max(b, c)), 0.f, 1.f);
    layers += double{high.x - low.x} * double{high.y - low.y};
  }
  if (layers <= kMostLayers) return {};
  return fmt::format(
      "its texture coordinates cover the texture {:.0f} times; at most {} times are possible",
      layers, kMostLayers);
}

/// The bones of the palm, of thumb and of fingers have a length and so a direction.
std::string fault_of_bones(const HandMesh& hand) {
  constexpr float kShortest_m = 0.001f;
  for (std::size_t joint = 0; joint < hand.rest.size(); ++joint) {
    const auto name = kJointNames[joint];
    if (!name.ends_with("-proximal") && !name.ends_with("-intermediate") &&
        !name.ends_with("-distal"))
      continue;
    const auto parent = static_cast<std::size_t>(kJointParent[joint]);
    const float length_m =
        glm::distance(glm::vec3(hand.rest[joint][3]), glm::vec3(hand.rest[parent][3]));
    if (length_m < kShortest_m)
      return fmt::format("its joints {} and {} lie in one place", kJointNames[parent], name);
  }
  return {};
}

}  // namespace

std::string fault_of_mesh(const HandMesh& hand) {
  for (auto* fault_of : {fault_of_size, fault_of_bones, fault_of_surface, fault_of_texture})
    if (auto fault = fault_of(hand); !fault.empty()) return fault;
  return {};
}

}  // namespace handcast::renderer
