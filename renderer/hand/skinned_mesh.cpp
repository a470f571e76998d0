// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/skinned_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <utility>

#include "renderer/hand/array_reader.hpp"
#include "renderer/hand/joint_names.hpp"
#include "renderer/hand/mesh_checks.hpp"

namespace handcast::renderer {
namespace {

constexpr std::size_t kMaxVertices = 65535;  ///< numbers of 16 bits name them

/// True for the palm, the tips and the metacarpals of the fingers, which move little or no skin.
bool may_be_missing(int joint) {
  const std::string_view name = kJointNames[joint];
  return name == "palm" || name.ends_with("-tip") || name.ends_with("finger-metacarpal");
}

/// A scale that is rounding: a mesh stays as it is to the last bit.
constexpr float kNoScale = 1e-4f;

/// The scale of a transform without shear or reflection; 0 of others, also if a number is not
/// finite: comparisons with NaN are false.
float scale_of(const glm::mat4& transform) {
  constexpr float kTolerance = 1e-2f;
  const glm::mat3 axes(transform);
  const float scale = std::cbrt(glm::determinant(axes));
  if (!(scale > 1e-6f && scale < 1e6f)) return 0;
  const glm::mat3 off = glm::transpose(axes) * axes / (scale * scale) - glm::mat3(1);
  for (int k = 0; k < 9; ++k)
    if (!(std::abs(off[k / 3][k % 3]) < kTolerance)) return 0;
  if (!std::isfinite(glm::dot(transform[3], transform[3]))) return 0;
  return std::abs(scale - 1) < kNoScale ? 1 : scale;
}

constexpr std::size_t kDeepest = 64;  ///< parents of a node that are looked at

/// The scale of a node's space in that of the scene.
double scale_of_node(const tinygltf::Model& model, int node) {
  double cubed = 1;
  for (std::size_t depth = 0; node >= 0 && depth < kDeepest; ++depth) {
    const auto& each = model.nodes[static_cast<std::size_t>(node)];
    if (each.matrix.size() == 16)
      cubed *= glm::determinant(glm::dmat3(glm::make_mat4(each.matrix.data())));
    for (const double scale : each.scale) cubed *= scale;
    const auto parent = std::ranges::find_if(model.nodes, [&](const auto& other) {
      return std::ranges::find(other.children, node) != other.children.end();
    });
    node = parent == model.nodes.end() ? -1 : static_cast<int>(parent - model.nodes.begin());
  }
  return std::cbrt(std::abs(cubed));
}

/// A joint of a skin that belongs to the other hand.
constexpr std::uint8_t kForeign = 255;

/// The joint of each joint of the skin: by its name, else that of its nearest parent with a known
/// one, else the wrist.
std::vector<std::uint8_t> joints_of(const tinygltf::Model& model, const tinygltf::Skin& skin,
                                    Side side) {
  std::map<int, std::uint8_t> of_node;
  std::array<bool, kJoints> taken{};
  for (const int node : skin.joints) {
    const auto name = parse_joint_name(model.nodes[static_cast<std::size_t>(node)].name);
    const int joint = joint_of(name.key);
    if (joint < 0) continue;
    if (name.side && *name.side != side)
      of_node[node] = kForeign;
    else if (!std::exchange(taken[static_cast<std::size_t>(joint)], true))
      of_node[node] = static_cast<std::uint8_t>(joint);
  }
  std::map<int, int> parent_of;
  for (std::size_t node = 0; node < model.nodes.size(); ++node)
    for (const int child : model.nodes[node].children)
      parent_of.try_emplace(child, static_cast<int>(node));
  std::vector<std::uint8_t> joints;
  for (int node : skin.joints) {
    for (std::size_t depth = 0; depth < kDeepest && !of_node.contains(node); ++depth) {
      const auto parent = parent_of.find(node);
      if (parent == parent_of.end()) break;
      node = parent->second;
    }
    joints.push_back(of_node.contains(node) ? of_node[node] : std::uint8_t{1});
  }
  return joints;
}

/// The names of a skin's joints, for a message.
std::string names_of(const tinygltf::Model& model, const tinygltf::Skin& skin) {
  constexpr std::size_t kMost = 4;
  std::string names;
  for (std::size_t k = 0; k < std::min(skin.joints.size(), kMost); ++k)
    names += fmt::format("{}'{}'", k == 0 ? "" : ", ",
                         model.nodes[static_cast<std::size_t>(skin.joints[k])].name.substr(0, 40));
  return names + (skin.joints.size() > kMost ? ", …" : "");
}

/// Fills rest, found, ours and scale.
void read_skeleton(ArrayReader& reader, const tinygltf::Model& model, const tinygltf::Skin& skin,
                   SkinnedMesh& mesh) {
  auto& rest = mesh.hand.rest;
  auto& found = mesh.found;
  for (const int node : skin.joints)
    if (node < 0 || node >= std::ssize(model.nodes))
      return reader.complain("its skin refers to a node that does not exist");
  const auto inverse = reader.read<float>(skin.inverseBindMatrices, 16, "inverse bind matrices");
  if (inverse.size() < skin.joints.size() * 16)
    return reader.complain("it has fewer inverse bind matrices than joints");
  mesh.ours = joints_of(model, skin, mesh.hand.side);
  std::array<float, kJoints> scales{};
  for (std::size_t k = 0; k < skin.joints.size(); ++k) {
    const int node = skin.joints[k];
    const auto name = parse_joint_name(model.nodes[static_cast<std::size_t>(node)].name);
    const auto joint = mesh.ours[k];
    if (joint == kForeign || joint_of(name.key) != joint || found[joint]) continue;
    found[joint] = true;
    const auto bind = glm::make_mat4(inverse.data() + k * 16);
    scales[joint] = scale_of(bind);
    if (scales[joint] == 0)
      return reader.complain(fmt::format(
          "the inverse bind matrix of its joint {} is not a rigid transform; apply the scales of "
          "armature and mesh in the program that made them",
          kJointNames[joint]));
    rest[joint] = glm::inverse(bind);
    if (joint == 1) mesh.scale = static_cast<float>(scale_of_node(model, node)) * scales[1];
  }
  std::string missing;
  for (int j = 0; j < kJoints; ++j)
    if (!found[j] && !may_be_missing(j))
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", kJointNames[j]);
  if (!missing.empty())
    return reader.complain(
        fmt::format("its skin lacks the joints {}; it has {}. Name them as WebXR does: "
                    "'index-finger-tip', also with 'left-' before or '.L' behind",
                    missing, names_of(model, skin)));
  for (int j = 0; j < kJoints; ++j) {
    if (!found[j]) continue;
    if (!(std::abs(scales[j] / scales[1] - 1) < 1e-2f))
      return reader.complain(
          fmt::format("the inverse bind matrix of its joint {} is not a rigid transform: it scales "
                      "otherwise than that of the wrist",
                      kJointNames[j]));
    for (int axis = 0; axis < 3; ++axis) rest[j][axis] *= scales[j];
    rest[j][3] = glm::vec4(mesh.scale * glm::vec3(rest[j][3]), 1);
  }
}

int attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

void read_weights(ArrayReader& reader, const tinygltf::Primitive& primitive, SkinnedMesh& mesh) {
  const auto& ours = mesh.ours;
  auto& hand = mesh.hand;

  const auto joints =
      reader.read<std::uint32_t>(attribute(primitive, "JOINTS_0"), 4, "joint indices");
  const auto weights = reader.read<float>(attribute(primitive, "WEIGHTS_0"), 4, "weights");
  if (joints.size() != weights.size())
    return reader.complain("its joint indices and weights differ in number");
  std::size_t loose = 0;  // vertices without a weight go with the wrist
  for (std::size_t v = 0; v < joints.size(); v += 4) {
    std::array<std::uint8_t, 4> joint{};
    std::array<float, 4> weight{};
    float sum = 0, alien = 0;
    for (int k = 0; k < 4; ++k) {
      if (!(weights[v + k] > 0)) continue;
      if (joints[v + k] >= ours.size())
        return reader.complain("it binds a vertex to a joint that its skin does not have");
      if (ours[joints[v + k]] == kForeign) {
        alien += weights[v + k];
        continue;
      }
      joint[k] = ours[joints[v + k]];
      sum += weight[k] = weights[v + k];
    }
    if (alien > sum) mesh.alien.push_back(static_cast<std::uint32_t>(hand.weights.size()));
    loose += sum + alien <= 0;
    if (sum <= 0) joint = {1, 0, 0, 0}, weight = {sum = 1, 0, 0, 0};
    for (float& w : weight) w /= sum;
    hand.joints.push_back(joint);
    hand.weights.push_back(weight);
  }
  constexpr std::size_t kFewest = 20;
  if (const auto count = weights.size() / 4; loose * kFewest > count)
    reader.complain(fmt::format("{} of its {} vertices are not bound to a joint", loose, count));
}

void read_triangles(ArrayReader& reader, const tinygltf::Primitive& primitive, std::size_t first,
                    std::size_t count, HandMesh& hand) {
  std::vector<std::uint32_t> indices;
  if (primitive.indices >= 0)
    indices = reader.read<std::uint32_t>(primitive.indices, 1, "indices");
  else
    for (std::uint32_t v = 0; v < count; ++v) indices.push_back(v);
  for (std::size_t k = 0; k + 2 < indices.size(); k += 3) {
    std::array<std::uint16_t, 3> triangle;
    for (int c = 0; c < 3; ++c) {
      if (indices[k + c] >= count)
        return reader.complain(fmt::format("a triangle refers to vertex {}, but there are only {}",
                                           indices[k + c], count));
      triangle[c] = static_cast<std::uint16_t>(first + indices[k + c]);
    }
    hand.triangles.push_back(triangle);
  }
  if (hand.triangles.size() > kMaxTriangles)
    reader.complain(fmt::format("it has more than {} triangles", kMaxTriangles));
}

void read_primitive(ArrayReader& reader, const tinygltf::Primitive& primitive, SkinnedMesh& mesh) {
  auto& hand = mesh.hand;
  const std::size_t first = hand.vertex_count();
  const auto positions = reader.read<float>(attribute(primitive, "POSITION"), 3, "positions");
  const std::size_t count = positions.size() / 3;
  if (first + count > kMaxVertices)
    return reader.complain(fmt::format("it has more than {} vertices", kMaxVertices));
  std::vector<float> normals(count * 3), uv(count * 2);
  if (attribute(primitive, "NORMAL") >= 0)
    normals = reader.read<float>(attribute(primitive, "NORMAL"), 3, "normals");
  if (attribute(primitive, "TEXCOORD_0") >= 0)
    uv = reader.read<float>(attribute(primitive, "TEXCOORD_0"), 2, "texture coordinates");
  read_weights(reader, primitive, mesh);
  if (reader.trouble()) return;
  if (normals.size() != count * 3 || uv.size() != count * 2 || hand.weights.size() != first + count)
    return reader.complain("its vertex attributes differ in number");
  for (std::size_t v = 0; v < count; ++v) {
    hand.positions.push_back(
        mesh.scale * glm::vec3(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]));
    hand.normals.emplace_back(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
    hand.uv.emplace_back(uv[2 * v], uv[2 * v + 1]);
  }
  read_triangles(reader, primitive, first, count, hand);
}

/// Takes the vertices and triangles out that belong to the other hand.
void drop_alien_vertices(SkinnedMesh& mesh) {
  auto& [hand, found, ours, alien, scale, covered] = mesh;
  if (alien.empty()) return;
  std::vector<int> place(hand.vertex_count());  // -1: dropped
  std::size_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (std::ranges::binary_search(alien, static_cast<std::uint32_t>(v))) {
      place[v] = -1;
      continue;
    }
    hand.positions[kept] = hand.positions[v];
    hand.normals[kept] = hand.normals[v];
    hand.uv[kept] = hand.uv[v];
    hand.joints[kept] = hand.joints[v];
    hand.weights[kept] = hand.weights[v];
    place[v] = static_cast<int>(kept++);
  }
  hand.positions.resize(kept), hand.normals.resize(kept), hand.uv.resize(kept);
  hand.joints.resize(kept), hand.weights.resize(kept);
  std::erase_if(hand.triangles, [&](const auto& triangle) {
    return std::ranges::any_of(triangle, [&](auto v) { return place[v] < 0; });
  });
  for (auto& triangle : hand.triangles)
    for (auto& v : triangle) v = static_cast<std::uint16_t>(place[v]);
}

void count_joints(SkinnedMesh& mesh) {
  std::array<bool, kJoints> moves{};
  for (std::size_t v = 0; v < mesh.hand.vertex_count(); ++v)
    for (int k = 0; k < 4; ++k)
      if (mesh.hand.weights[v][k] > 0.4f) moves[mesh.hand.joints[v][k]] = true;
  mesh.covered = static_cast<std::size_t>(std::ranges::count(moves, true));
}

std::string_view name_of(Side side) { return side == Side::left ? "left" : "right"; }

}  // namespace

/// Joints that the model lacks get the frames of their parents.
void fill_missing_joints(SkinnedMesh& mesh) {
  for (int k = 1; k <= kJoints; ++k) {
    const int j = k % kJoints;  // the wrist first, the palm last: parents come before children
    if (!mesh.found[j] && kJointParent[j] >= 0) mesh.hand.rest[j] = mesh.hand.rest[kJointParent[j]];
  }
}

tl::expected<SkinnedMesh, std::string> read_skinned_mesh(const tinygltf::Model& model,
                                                         const tinygltf::Node& node, Side side) {
  SkinnedMesh mesh;
  mesh.hand.side = side;
  ArrayReader reader(model);
  read_skeleton(reader, model, model.skins[static_cast<std::size_t>(node.skin)], mesh);
  for (const tinygltf::Primitive& primitive :
       model.meshes[static_cast<std::size_t>(node.mesh)].primitives)
    if (!reader.trouble() && (primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode < 0))
      read_primitive(reader, primitive, mesh);
  if (reader.trouble()) return tl::make_unexpected(*reader.trouble());
  fill_missing_joints(mesh);
  drop_alien_vertices(mesh);
  auto& hand = mesh.hand;
  if (hand.triangles.empty()) return tl::make_unexpected("its skinned mesh has no triangles");
  if (auto fault = fault_of_mesh(hand); !fault.empty()) return tl::make_unexpected(fault);
  if (!has_palm(hand.rest)) return tl::make_unexpected("its wrist and knuckles lie in a line");
  if (const auto is = side_of_joints(hand.rest); is && *is != side)
    return tl::make_unexpected(
        fmt::format("it is a {0} hand, by its thumb; name it as hand.{0}, and as hand.{1} a model "
                    "of a {1} hand",
                    name_of(*is), name_of(side)));
  count_joints(mesh);
  return mesh;
}

}  // namespace handcast::renderer
