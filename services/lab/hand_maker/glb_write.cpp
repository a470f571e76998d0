// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/glb_write.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <string>

// glTF 2.0, sections 3.6 (accessors) and 4.4 (binary glTF): a JSON chunk describes the arrays of
// the binary chunk.
namespace handcast::renderer {
namespace {

using nlohmann::json;

enum ComponentType { kUint8 = 5121, kUint16 = 5123, kFloat = 5126 };
enum ViewTarget { kNoTarget = 0, kVertexData = 34962, kIndexData = 34963 };
enum AccessorIndex {
  kPosition,
  kNormal,
  kTexcoord,
  kJointsIndex,
  kWeights,
  kIndices,
  kInverseBind
};

/// Collects arrays in one buffer, each aligned to four bytes, with its view and accessor.
class BufferWriter {
 public:
  template <class T>
  json& add(const std::vector<T>& values, const char* type, ComponentType component,
            std::size_t count, ViewTarget target) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t offset = bytes_.size(), length = values.size() * sizeof(T);
    bytes_.resize(offset + length);
    std::memcpy(bytes_.data() + offset, values.data(), length);
    json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}};
    if (target != kNoTarget) view["target"] = target;
    accessors_.push_back({{"bufferView", views_.size()},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    views_.push_back(std::move(view));
    return accessors_.back();
  }

  void finish(json& gltf) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    gltf["bufferViews"] = views_;
    gltf["accessors"] = accessors_;
    gltf["buffers"] = {{{"byteLength", bytes_.size()}}};
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  json views_ = json::array(), accessors_ = json::array();
};

std::vector<glm::mat4> inverse_bind_matrices(const HandMesh& hand) {
  std::vector<glm::mat4> inverse;
  for (const glm::mat4& rest : hand.rest) inverse.push_back(glm::inverse(rest));
  return inverse;
}

void add_arrays(BufferWriter& buffer, const HandMesh& hand) {
  const std::size_t count = hand.vertex_count();
  glm::vec3 low = hand.positions.front(), high = low;
  for (const glm::vec3& p : hand.positions) low = glm::min(low, p), high = glm::max(high, p);
  json& position = buffer.add(hand.positions, "VEC3", kFloat, count, kVertexData);
  position["min"] = {low.x, low.y, low.z};
  position["max"] = {high.x, high.y, high.z};
  buffer.add(hand.normals, "VEC3", kFloat, count, kVertexData);
  buffer.add(hand.uv, "VEC2", kFloat, count, kVertexData);
  buffer.add(hand.joints, "VEC4", kUint8, count, kVertexData);
  buffer.add(hand.weights, "VEC4", kFloat, count, kVertexData);
  buffer.add(hand.triangles, "SCALAR", kUint16, hand.triangles.size() * 3, kIndexData);
  buffer.add(inverse_bind_matrices(hand), "MAT4", kFloat, kJoints, kNoTarget);
}

/// The node of a joint, relative to its parent, so that other programs show a skeleton.
json joint_node(const HandMesh& hand, int joint) {
  const int parent = kJointParent[joint];
  const glm::mat4 local =
      parent < 0 ? hand.rest[joint] : glm::inverse(hand.rest[parent]) * hand.rest[joint];
  const glm::quat q = glm::normalize(glm::quat_cast(glm::mat3(local)));
  json node{{"name", kJointNames[joint]},
            {"translation", {local[3].x, local[3].y, local[3].z}},
            {"rotation", {q.x, q.y, q.z, q.w}}};
  json children = json::array();
  for (int child = 0; child < kJoints; ++child)
    if (kJointParent[child] == joint) children.push_back(child);
  if (!children.empty()) node["children"] = std::move(children);
  return node;
}

json scene_of(const HandMesh& hand) {
  json nodes = json::array(), joints = json::array();
  int root = 0;
  for (int j = 0; j < kJoints; ++j) {
    nodes.push_back(joint_node(hand, j));
    joints.push_back(j);
    if (kJointParent[j] < 0) root = j;
  }
  nodes.push_back(
      {{"name", hand.side == Side::left ? "hand-left" : "hand-right"}, {"mesh", 0}, {"skin", 0}});
  const json attributes{{"POSITION", kPosition},
                        {"NORMAL", kNormal},
                        {"TEXCOORD_0", kTexcoord},
                        {"JOINTS_0", kJointsIndex},
                        {"WEIGHTS_0", kWeights}};
  json gltf;
  gltf["asset"] = {{"version", "2.0"}, {"generator", "handcast"}};
  gltf["scene"] = 0;
  gltf["scenes"] = {{{"nodes", {root, kJoints}}}};
  gltf["nodes"] = std::move(nodes);
  gltf["meshes"] = {
      {{"primitives", {{{"attributes", attributes}, {"indices", kIndices}, {"material", 0}}}}}};
  gltf["materials"] = {{{"name", "skin"},
                        {"pbrMetallicRoughness",
                         {{"baseColorFactor", {0.8, 0.62, 0.52, 1}},
                          {"metallicFactor", 0},
                          {"roughnessFactor", 0.7}}}}};
  gltf["skins"] = {
      {{"inverseBindMatrices", kInverseBind}, {"joints", std::move(joints)}, {"skeleton", root}}};
  return gltf;
}

void put_u32(std::ostream& out, std::size_t value) {
  const auto word = static_cast<std::uint32_t>(value);
  out.write(reinterpret_cast<const char*>(&word), sizeof word);
}

}  // namespace

Result<void> save_hand(const HandMesh& hand, const std::filesystem::path& file) {
  if (hand.positions.empty())
    return fail(Errc::bad_data,
                fmt::format("hand '{}': an empty mesh cannot be saved", file.string()));
  BufferWriter buffer;
  add_arrays(buffer, hand);
  json gltf = scene_of(hand);
  buffer.finish(gltf);
  std::string text = gltf.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');

  constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
  std::ofstream out(file, std::ios::binary);
  put_u32(out, kMagic);
  put_u32(out, 2);
  put_u32(out, 12 + 8 + text.size() + 8 + buffer.bytes().size());
  put_u32(out, text.size());
  put_u32(out, kJsonChunk);
  out << text;
  put_u32(out, buffer.bytes().size());
  put_u32(out, kBinaryChunk);
  out << buffer.bytes();
  out.close();
  if (!out)
    return fail(Errc::unavailable,
                fmt::format("hand '{}': the file cannot be written", file.string()));
  return {};
}

}  // namespace handcast::renderer
