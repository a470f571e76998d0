// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <optional>

#include "renderer/hand/gltf_file.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/hand/mesh_charts.hpp"
#include "renderer/hand/mesh_checks.hpp"

namespace handcast::renderer {
namespace {

constexpr std::size_t kMaxVertices = 65535;
constexpr std::size_t kMaxTriangles = 65534;  ///< numbers of 16 bits name them

/// Reads accessors, which tinygltf does not check, as rows of `width` numbers. An accessor that
/// cannot be read gives an empty vector; the reason of the first failure is kept.
class ArrayReader {
 public:
  explicit ArrayReader(const tinygltf::Model& model) : model_(model) {}

  /// All numbers of an accessor, row by row; integers flagged as normalised become 0..1. `what`
  /// names them in messages.
  template <class T>
  std::vector<T> read(int accessor_index, int width, const char* what) {
    std::vector<T> numbers;
    const auto bytes = locate(accessor_index, width, what);
    if (!bytes) return numbers;
    const tinygltf::Accessor& accessor = model_.accessors[accessor_index];
    numbers.reserve(accessor.count * width);
    for (std::size_t row = 0; row < accessor.count; ++row)
      for (int k = 0; k < width; ++k) {
        const double value = number(accessor, bytes->data + row * bytes->stride, k);
        if (!std::isfinite(value))
          return complain(fmt::format("its {} contain a number that is not finite", what)),
                 std::vector<T>{};
        if (value < double(std::numeric_limits<T>::lowest()) ||
            value > double(std::numeric_limits<T>::max()))
          return complain(fmt::format("its {} contain {:.6g}, which is out of range", what, value)),
                 std::vector<T>{};
        numbers.push_back(static_cast<T>(value));
      }
    return numbers;
  }
  const std::optional<std::string>& trouble() const { return trouble_; }
  void complain(std::string what) {
    if (!trouble_) trouble_ = std::move(what);
  }

 private:
  struct Rows {
    const unsigned char* data;
    std::size_t stride;
  };

  std::optional<Rows> locate(int index, int width, const char* what) {
    const auto refuse = [&](const char* why) {
      complain(fmt::format("its {} {}", what, why));
      return std::nullopt;
    };
    if (index < 0 || index >= std::ssize(model_.accessors)) return refuse("are missing");
    const tinygltf::Accessor& accessor = model_.accessors[index];
    if (accessor.bufferView < 0 || accessor.bufferView >= std::ssize(model_.bufferViews))
      return refuse("have no buffer view");
    const tinygltf::BufferView& view = model_.bufferViews[accessor.bufferView];
    if (view.buffer < 0 || view.buffer >= std::ssize(model_.buffers))
      return refuse("have no buffer");
    const auto& buffer = model_.buffers[view.buffer].data;
    const int component =
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    if (component <= 0 ||
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != width)
      return refuse("have an unexpected type");
    const std::size_t row = static_cast<std::size_t>(component) * width,
                      stride = view.byteStride ? view.byteStride : row;
    if (accessor.count == 0) return refuse("are empty");
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
      return refuse("lie outside their buffer");
    if (accessor.byteOffset > view.byteLength || row > view.byteLength - accessor.byteOffset ||
        (accessor.count - 1) > (view.byteLength - accessor.byteOffset - row) / stride)
      return refuse("lie outside their buffer view");
    if (accessor.count > 3 * kMaxTriangles) return refuse("are too many");
    if (stride < row) return refuse("overlap");
    return Rows{buffer.data() + view.byteOffset + accessor.byteOffset, stride};
  }

  template <class Component>
  static double component_at(const unsigned char* row, int k, bool normalized) {
    Component value;
    std::memcpy(&value, row + sizeof(Component) * k, sizeof value);
    return normalized ? double(value) / double(std::numeric_limits<Component>::max())
                      : double(value);
  }

  static double number(const tinygltf::Accessor& accessor, const unsigned char* row, int k) {
    switch (accessor.componentType) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return component_at<std::uint8_t>(row, k, accessor.normalized);
      case TINYGLTF_COMPONENT_TYPE_BYTE:
        return component_at<std::int8_t>(row, k, accessor.normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return component_at<std::uint16_t>(row, k, accessor.normalized);
      case TINYGLTF_COMPONENT_TYPE_SHORT:
        return component_at<std::int16_t>(row, k, accessor.normalized);
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return component_at<std::uint32_t>(row, k, accessor.normalized);
      case TINYGLTF_COMPONENT_TYPE_DOUBLE:
        return component_at<double>(row, k, false);
      default:
        return component_at<float>(row, k, false);
    }
  }

  const tinygltf::Model& model_;
  std::optional<std::string> trouble_;
};

/// The spelling of WebXR for names such as "Left_Index-Finger-Tip" and "r-little-finger-tip".
std::string plain_name(std::string name) {
  for (char& c : name)
    c = c == '_' || c == ' ' || c == '.'
            ? '-'
            : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const std::string_view prefix : {"left-", "right-", "l-", "r-"})
    if (name.starts_with(prefix)) {
      name.erase(0, prefix.size());
      break;
    }
  if (name.starts_with("little-")) name.replace(0, 6, "pinky");
  return name;
}

/// True for the palm, the tips and the metacarpals of the fingers, which move little or no skin.
bool may_be_missing(int joint) {
  const std::string_view name = kJointNames[joint];
  return name == "palm" || name.ends_with("-tip") || name.ends_with("finger-metacarpal");
}

/// True for a rotation and a translation. False if a number is not finite: comparisons with NaN are
/// false.
bool is_rigid(const glm::mat4& transform) {
  constexpr float kTolerance = 1e-2f;
  const glm::mat3 axes(transform);
  const glm::mat3 off = glm::transpose(axes) * axes - glm::mat3(1);
  for (int k = 0; k < 9; ++k)
    if (!(std::abs(off[k / 3][k % 3]) < kTolerance)) return false;
  return glm::determinant(axes) > 0 && std::isfinite(glm::dot(transform[3], transform[3]));
}

/// Fills hand.rest. Returns the index into kJointNames of each joint of the skin; joints with
/// unknown names become the wrist.
std::vector<std::uint8_t> read_skeleton(ArrayReader& reader, const tinygltf::Model& model,
                                        const tinygltf::Skin& skin, HandMesh& hand) {
  std::vector<std::uint8_t> ours(skin.joints.size(), 1);
  std::array<bool, kJoints> found{};
  const auto inverse = reader.read<float>(skin.inverseBindMatrices, 16, "inverse bind matrices");
  if (inverse.size() < skin.joints.size() * 16)
    return reader.complain("it has fewer inverse bind matrices than joints"), ours;
  for (std::size_t k = 0; k < skin.joints.size(); ++k) {
    const int node = skin.joints[k];
    if (node < 0 || node >= std::ssize(model.nodes))
      return reader.complain("its skin refers to a node that does not exist"), ours;
    const auto known =
        std::find(kJointNames.begin(), kJointNames.end(), plain_name(model.nodes[node].name));
    if (known == kJointNames.end()) continue;
    const auto joint = static_cast<std::size_t>(known - kJointNames.begin());
    hand.rest[joint] = glm::inverse(glm::make_mat4(inverse.data() + k * 16));
    if (!is_rigid(hand.rest[joint]))
      reader.complain(
          fmt::format("the inverse bind matrix of its joint {} is not a rigid transform", *known));
    ours[k] = static_cast<std::uint8_t>(joint);
    found[joint] = true;
  }
  std::string missing;
  for (int j = 0; j < kJoints; ++j)
    if (!found[j] && !may_be_missing(j))
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", kJointNames[j]);
  if (!missing.empty()) reader.complain(fmt::format("its skin lacks the joints {}", missing));
  for (int k = 1; k <= kJoints; ++k) {
    const int j = k % kJoints;  // the wrist first, the palm last: parents come before children
    if (!found[j] && kJointParent[j] >= 0) hand.rest[j] = hand.rest[kJointParent[j]];
  }
  return ours;
}

int attribute(const tinygltf::Primitive& primitive, const char* name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

void read_weights(ArrayReader& reader, const tinygltf::Primitive& primitive,
                  const std::vector<std::uint8_t>& ours, HandMesh& hand) {
  const auto joints =
      reader.read<std::uint32_t>(attribute(primitive, "JOINTS_0"), 4, "joint indices");
  const auto weights = reader.read<float>(attribute(primitive, "WEIGHTS_0"), 4, "weights");
  if (joints.size() != weights.size())
    return reader.complain("its joint indices and weights differ in number");
  std::size_t loose = 0;  // vertices without a weight go with the wrist
  for (std::size_t v = 0; v < joints.size(); v += 4) {
    std::array<std::uint8_t, 4> joint{};
    std::array<float, 4> weight{};
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      if (!(weights[v + k] > 0)) continue;
      if (joints[v + k] >= ours.size())
        return reader.complain("it binds a vertex to a joint that its skin does not have");
      joint[k] = ours[joints[v + k]];
      sum += weight[k] = weights[v + k];
    }
    loose += sum <= 0;
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

void read_primitive(ArrayReader& reader, const tinygltf::Primitive& primitive,
                    const std::vector<std::uint8_t>& ours, HandMesh& hand) {
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
  read_weights(reader, primitive, ours, hand);
  if (reader.trouble()) return;
  if (normals.size() != count * 3 || uv.size() != count * 2 || hand.weights.size() != first + count)
    return reader.complain("its vertex attributes differ in number");
  for (std::size_t v = 0; v < count; ++v) {
    hand.positions.emplace_back(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
    hand.normals.emplace_back(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
    hand.uv.emplace_back(uv[2 * v], uv[2 * v + 1]);
  }
  read_triangles(reader, primitive, first, count, hand);
}

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

const tinygltf::Node* first_skinned_node(const tinygltf::Model& model) {
  for (const tinygltf::Node& node : model.nodes)
    if (node.skin >= 0 && node.skin < std::ssize(model.skins) && node.mesh >= 0 &&
        node.mesh < std::ssize(model.meshes))
      return &node;
  return nullptr;
}

}  // namespace

Result<HandMesh> load_hand(const std::filesystem::path& file, Side side) {
  const auto refuse = [&](const std::string& why) {
    return fail(Errc::bad_config, fmt::format("hand '{}': {}", file.string(), why));
  };
  const auto model = read_gltf(file);
  if (!model) return tl::make_unexpected(model.error());
  const tinygltf::Node* node = first_skinned_node(*model);
  if (!node) return refuse("it contains no skinned mesh");

  HandMesh hand;
  hand.side = side;
  ArrayReader reader(*model);
  const auto ours = read_skeleton(reader, *model, model->skins[node->skin], hand);
  for (const tinygltf::Primitive& primitive : model->meshes[node->mesh].primitives)
    if (!reader.trouble() && (primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode < 0))
      read_primitive(reader, primitive, ours, hand);
  if (reader.trouble()) return refuse(*reader.trouble());
  if (hand.triangles.empty()) return refuse("its skinned mesh has no triangles");
  if (const auto fault = fault_of_mesh(hand); !fault.empty()) return refuse(fault);
  fill_missing_normals(hand);
  number_charts(hand);
  return hand;
}

}  // namespace handcast::renderer
