// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/ground_truth_mesh.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/implicit/implicit_hand.hpp"

namespace handcast::twin {
namespace {

glm::vec3 mirrored(const glm::vec3& v) { return {-v.x, v.y, v.z}; }

/// The mirror image in x. A joint's axes stay right-handed.
renderer::HandMesh mirrored(renderer::HandMesh hand) {
  hand.side = hand.side == renderer::Side::left ? renderer::Side::right : renderer::Side::left;
  for (auto& position : hand.positions) position = mirrored(position);
  for (auto& normal : hand.normals) normal = mirrored(normal);
  for (auto& triangle : hand.triangles) std::swap(triangle[1], triangle[2]);
  hand.rest = twin::mirrored(hand.rest);
  return hand;
}

GroundTruthMesh of_side(renderer::HandMesh left, renderer::Side side) {
  return {side == renderer::Side::left ? std::move(left) : mirrored(std::move(left)), false};
}

/// True if the index finger lies where a left hand has the little finger. The wrist's +y points out
/// of the back, as WebXR has it.
bool is_right(const renderer::HandMesh& hand) {
  constexpr std::size_t kWrist = 1, kIndex = 7, kMiddle = 12, kLittle = 22;
  const auto at = [&](std::size_t joint) { return glm::vec3(hand.rest[joint][3]); };
  return glm::dot(glm::cross(at(kMiddle) - at(kWrist), at(kIndex) - at(kLittle)),
                  glm::vec3(hand.rest[kWrist][1])) > 0;
}

/// True if a tip lies on the joint before it, as load_hand() places one that is missing.
bool lacks_tips(const renderer::HandMesh& hand) {
  for (std::size_t joint = 0; joint < hand.rest.size(); ++joint) {
    if (!renderer::kJointNames[joint].ends_with("-tip")) continue;
    const auto before = static_cast<std::size_t>(renderer::kJointParent[joint]);
    if (glm::distance(glm::vec3(hand.rest[joint][3]), glm::vec3(hand.rest[before][3])) < 1e-3f)
      return true;
  }
  return false;
}

}  // namespace

std::filesystem::path webxr_hand_file() {
  if (const char* named = std::getenv("HANDCAST_WEBXR_HAND")) return named;
  const std::filesystem::path installed = "/usr/local/share/handcast-hands/webxr/left.glb";
  std::error_code ignored;
  return std::filesystem::exists(installed, ignored) ? installed : std::filesystem::path();
}

Result<GroundTruthMesh> load_ground_truth_mesh(const std::string& mesh,
                                               const renderer::HandMesh& drawn) {
  if (mesh == "handcast") return GroundTruthMesh{drawn, true};
  if (mesh == "implicit") return of_side(implicit_hand(), drawn.side);
  std::filesystem::path file = mesh;
  if (mesh == "webxr") {
    file = webxr_hand_file();
    if (file.empty()) return GroundTruthMesh{drawn, true};
  }
  auto left = renderer::load_hand(file, renderer::Side::left);
  if (!left) return tl::make_unexpected(left.error());
  if (lacks_tips(*left))
    return fail(Errc::bad_config,
                fmt::format("twin.shape.mesh: {} has no joints at the finger tips, so that the "
                            "lengths of its last phalanges are unknown",
                            file.string()));
  if (is_right(*left))
    return fail(
        Errc::bad_config,
        fmt::format("twin.shape.mesh: {} is a right hand, or the +y axis of its wrist does not "
                    "point out of its back; name a left hand, which is mirrored for the right",
                    file.string()));
  return of_side(std::move(*left), drawn.side);
}

}  // namespace handcast::twin
