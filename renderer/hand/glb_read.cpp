// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "ipc/base/log.hpp"
#include "renderer/hand/gltf_file.hpp"
#include "renderer/hand/hand_axes.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/hand/mesh_charts.hpp"
#include "renderer/hand/mesh_checks.hpp"
#include "renderer/hand/skinned_mesh.hpp"

namespace handcast::renderer {
namespace {

/// Vertices without a normal get the mean normal of their triangles, weighted by area.
void fill_missing_normals(HandMesh& hand) {
  std::vector<glm::vec3> sum(hand.vertex_count());
  for (const auto& t : hand.triangles) {
    const glm::vec3& a = hand.positions[t[0]];
    const glm::vec3 n = glm::cross(hand.positions[t[1]] - a, hand.positions[t[2]] - a);
    for (const auto v : t) sum[v] += n;
  }
  for (std::size_t v = 0; v < hand.vertex_count(); ++v)
    if (hand.normals[v] == glm::vec3(0))
      hand.normals[v] = sum[v] / std::max(glm::length(sum[v]), 1e-20f);
}

/// The mesh that is the hand: of those that can be one, that which most joints move. A cuff or a
/// ring may be skinned too, and a file may have both hands.
tl::expected<SkinnedMesh, std::string> find_hand(const tinygltf::Model& model, Side side) {
  constexpr int kMostMeshes = 32;  // so that a malicious file is read soon
  int meshes = 0;
  tl::expected<SkinnedMesh, std::string> best = tl::make_unexpected("it contains no skinned mesh");
  for (const tinygltf::Node& node : model.nodes) {
    if (node.skin < 0 || node.skin >= std::ssize(model.skins) || node.mesh < 0 ||
        node.mesh >= std::ssize(model.meshes) || meshes == kMostMeshes)
      continue;
    auto candidate = read_skinned_mesh(model, node, side);
    const bool is_first = meshes++ == 0;
    const bool is_better =
        candidate && (!best || candidate->covered > best->covered ||
                      (candidate->covered == best->covered &&
                       candidate->hand.vertex_count() > best->hand.vertex_count()));
    if (is_first || is_better) best = std::move(candidate);
  }
  return best;
}

/// Why an extension that a file requires cannot be read; empty if it does not change the mesh.
std::string fault_of_extension(const std::string& name) {
  if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression")
    return "export it without compression";
  if (name == "KHR_texture_transform")
    return "export it with the transform applied to its texture coordinates";
  constexpr std::array<std::string_view, 4> kHarmless{"KHR_mesh_quantization", "KHR_texture_basisu",
                                                      "EXT_texture_webp", "EXT_texture_avif"};
  if (name.starts_with("KHR_materials_") || name.starts_with("KHR_lights_") ||
      std::ranges::find(kHarmless, name) != kHarmless.end())
    return {};
  return "export it without this extension";
}

}  // namespace

Result<HandMesh> load_hand(const std::filesystem::path& file, Side side) {
  const auto refuse = [&](const std::string& why) {
    return fail(Errc::bad_config, fmt::format("hand '{}': {}", file.string(), why));
  };
  const auto model = read_gltf(file);
  if (!model) return tl::make_unexpected(model.error());
  for (const auto& extension : model->extensionsRequired)
    if (const auto remedy = fault_of_extension(extension); !remedy.empty())
      return refuse(
          fmt::format("it requires the glTF extension '{}', which handcast does not read; {}",
                      extension.substr(0, 60), remedy));
  auto candidate = find_hand(*model, side);
  if (!candidate) return refuse(candidate.error());
  auto hand = std::move(candidate->hand);
  fill_missing_normals(hand);
  if (const auto done = settle_axes(hand, candidate->found); !done.empty()) {
    candidate->hand.rest = hand.rest;
    fill_missing_joints(*candidate);
    hand.rest = candidate->hand.rest;
    log::info("hand '{}': {}", file.string(), done);
  }
  if (const auto fault = fault_when_bent(hand); !fault.empty()) return refuse(fault);
  number_charts(hand);
  return hand;
}

}  // namespace handcast::renderer
