// SPDX-License-Identifier: Apache-2.0
#include "services/content/shader/hand_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/draw/cpu/nearest_pixel.hpp"

namespace handcast::content::shader {
namespace {

/// A uniform, without its prefix.
struct Uniform {
  std::string_view type, name;
  bool is_list, is_live;
};
constexpr Uniform kUniforms[] = {
    {"int", "there", false, true},    {"int", "side", false, false},
    {"vec3", "joint", true, true},    {"vec3", "rest_joint", true, false},
    {"vec2", "palm_uv", true, false}, {"vec2", "back_uv", true, false},
    {"float", "pinch", false, true},  {"float", "spread", false, true},
    {"float", "curl", false, true},   {"float", "speed", false, true},
    {"vec3", "normal", false, true},  {"vec3", "gravity", false, true},
};
constexpr std::string_view kPrefixes[] = {"hand_", "other_"};

enum MapKind { kRest, kBone, kPosition, kNormal };
constexpr std::string_view kMaps[] = {"hand_rest", "hand_bone", "hand_position",
                                      "hand_surface_normal"};

bool is_live_map(MapKind kind) { return kind == kPosition || kind == kNormal; }

MapKind kind_of(std::string_view sampler) {
  return static_cast<MapKind>(std::ranges::find(kMaps, sampler) - std::begin(kMaps));
}

/// 1 for a chart of the back, -1 for one of the palm.
std::vector<float> facing_of(const renderer::HandMesh& mesh) {
  std::vector<float> outwards(256);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    outwards[mesh.chart[v]] += glm::dot(mesh.normals[v], glm::vec3(mesh.rest[1][1]));
  for (float& each : outwards) each = each < 0 ? -1.f : 1.f;
  return outwards;
}

glm::vec3 in_wrist_mm(const renderer::HandMesh& mesh, const glm::vec3& model_m) {
  return 1000.f * glm::vec3(glm::inverse(mesh.rest[1]) * glm::vec4(model_m, 1));
}

/// The joint with the largest weight in the corners of a texel.
int strongest_joint(const renderer::HandMesh& mesh, const SurfaceTexel& texel) {
  std::array<float, kJoints> weights{};
  for (std::size_t corner = 0; corner < 3; ++corner)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto v = texel.corners[corner];
      if (mesh.joints[v][k] < kJoints)
        weights[mesh.joints[v][k]] += texel.parts[corner] * mesh.weights[v][k];
    }
  return static_cast<int>(std::ranges::max_element(weights) - weights.begin());
}

/// By vertex, the joint that has more than half of its weight; -1 if none has.
std::vector<int> ruling_joints(const renderer::HandMesh& mesh) {
  std::vector<int> joints(mesh.vertex_count(), -1);
  for (std::size_t v = 0; v < joints.size(); ++v)
    for (std::size_t k = 0; k < 4; ++k)
      if (mesh.joints[v][k] < kJoints && mesh.weights[v][k] > 0.5f) joints[v] = mesh.joints[v][k];
  return joints;
}

/// The joint at the other end of the bone that begins at a joint; itself at a tip.
int next_joint(int joint) {
  constexpr int kPalmJoint = 0, kWristJoint = 1, kMiddle = 12;
  if (joint == kPalmJoint || joint == kWristJoint) return kMiddle;
  const bool is_tip = joint == 5 || (joint > 5 && joint % 5 == 0);
  return is_tip ? joint : joint + 1;
}

}  // namespace

HandView::HandView(const std::set<std::string, std::less<>>& words, const Opening& opening)
    : words_(words),
      meshes_{opening.meshes[static_cast<std::size_t>(opening.side)],
              opening.meshes[1 - static_cast<std::size_t>(opening.side)]},
      side_(opening.side),
      width_(opening.width),
      height_(opening.height) {
  for (const auto sampler : kMaps)
    if (words_.contains(sampler)) samplers_.emplace_back(sampler);
  images_.resize(samplers_.size());
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    bool needs_places = false;
    for (const auto& uniform : kUniforms) {
      if (!mentions(kPrefixes[i], uniform.name)) continue;
      is_live_ |= uniform.is_live;
      needs_places |= uniform.is_list && !uniform.is_live;
    }
    if (needs_places && meshes_[i]) places_[i] = places_on(*meshes_[i], width_, height_);
  }
  for (const auto& sampler : samplers_) is_live_ |= is_live_map(kind_of(sampler));
  if (samplers_.empty() || !meshes_[0]) return;
  facing_ = facing_of(*meshes_[0]);
  rest_mm_ = rest_positions_mm(*meshes_[0]);
  bones_ = bones_of(*meshes_[0]);
  ruling_ = ruling_joints(*meshes_[0]);
  for (const auto& sampler : samplers_) {
    const bool is_live = is_live_map(kind_of(sampler));
    auto& layout = is_live ? live_ : at_rest_;
    const int part = is_live ? 2 : 1;
    if (!layout)
      layout = lay_out(*meshes_[0], (width_ + part - 1) / part, (height_ + part - 1) / part);
  }
}

bool HandView::mentions(std::string_view prefix, std::string_view name) const {
  return words_.contains(fmt::format("{}{}", prefix, name));
}

/// Finds the texels of the charts, and those beside them.
HandView::Layout HandView::lay_out(const renderer::HandMesh& mesh, int width, int height) {
  Layout layout{width, height, surface_map_of(mesh, width, height), {}, {}};
  renderer::Image<std::uint8_t> on(width, height), off(width, height, 1);
  for (const auto& texel : layout.surface->texels()) {
    on.pixels()[texel.index] = 1;
    off.pixels()[texel.index] = 0;
  }
  constexpr int kReach = renderer::cpu::NearestPixel::kLargestReach;
  renderer::cpu::NearestPixel nearest;
  for (const auto& way : nearest.find(on.view(), off.view(), kReach))
    layout.beside.push_back({static_cast<std::uint32_t>(way.y * width + way.x),
                             static_cast<std::uint32_t>((way.y + way.dy) * width + way.x + way.dx),
                             std::sqrt(static_cast<float>(way.squared_px))});
  layout.edge_px.assign(on.pixels().size(), static_cast<float>(kReach));
  for (const auto& way : nearest.find(off.view(), on.view(), kReach))
    layout.edge_px[static_cast<std::size_t>(way.y) * static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(way.x)] = std::sqrt(static_cast<float>(way.squared_px));
  return layout;
}

/// Under a joint is the texel of the palm, and of the back, that is nearest to it as seen from
/// above.
HandView::Places HandView::places_on(const renderer::HandMesh& mesh, int width, int height) {
  Places places;
  std::array<float, kJoints> joint_x{}, joint_z{};
  for (std::size_t j = 0; j < joint_x.size(); ++j) {
    places.rest_mm[j] = in_wrist_mm(mesh, glm::vec3(mesh.rest[j][3]));
    joint_x[j] = places.rest_mm[j].x;
    joint_z[j] = places.rest_mm[j].z;
  }
  const auto map = surface_map_of(mesh, width, height);
  const auto facing = facing_of(mesh);
  const auto rest_mm = rest_positions_mm(mesh);
  std::array<std::array<float, kJoints>, 2> nearest{};
  for (auto& each : nearest) each.fill(1e9f);
  for (const auto& texel : map->texels()) {
    const bool is_back = facing[mesh.chart[texel.corners[0]]] > 0;
    const glm::vec3 at = texel.of<glm::vec3>(rest_mm);
    const std::uint32_t row = texel.index / static_cast<std::uint32_t>(width);
    const auto x = static_cast<float>(texel.index % static_cast<std::uint32_t>(width)),
               y = static_cast<float>(row);
    const glm::vec2 uv((x + 0.5f) / static_cast<float>(width),
                       1 - (y + 0.5f) / static_cast<float>(height));
    // Few texels are nearer to any joint than those before.
    std::array<float, kJoints> distance{};
    auto& best = nearest[is_back];
    int nearer = 0;
    for (std::size_t j = 0; j < distance.size(); ++j) {
      const float dx = at.x - joint_x[j], dz = at.z - joint_z[j];
      distance[j] = dx * dx + dz * dz;
      nearer += distance[j] < best[j];
    }
    for (std::size_t j = 0; nearer > 0 && j < distance.size(); ++j) {
      if (distance[j] >= best[j]) continue;
      best[j] = distance[j];
      (is_back ? places.back_uv : places.palm_uv)[j] = uv;
    }
  }
  return places;
}

std::string HandView::declarations() const {
  std::string text;
  for (const auto prefix : kPrefixes)
    for (const auto& uniform : kUniforms)
      if (mentions(prefix, uniform.name))
        text += fmt::format("uniform {} {}{}{};\n", uniform.type, prefix, uniform.name,
                            uniform.is_list ? fmt::format("[{}]", kJoints) : "");
  for (const auto& sampler : samplers_) text += fmt::format("uniform sampler2D {};\n", sampler);
  return text;
}

Needs HandView::needs() const {
  Needs needs;
  for (const auto& sampler : samplers_) needs.surface |= is_live_map(kind_of(sampler));
  return needs;
}

glm::vec4 HandView::at_rest(const SurfaceTexel& texel) const {
  return {texel.of<glm::vec3>(rest_mm_), facing_[meshes_[0]->chart[texel.corners[0]]]};
}

/// The bones that begin at the joints, at rest.
std::array<HandView::Bone, kJoints> HandView::bones_of(const renderer::HandMesh& mesh) {
  std::array<Bone, kJoints> bones;
  for (int joint = 0; joint < kJoints; ++joint) {
    auto& bone = bones[static_cast<std::size_t>(joint)];
    bone.begin_mm = in_wrist_mm(mesh, glm::vec3(mesh.rest[joint][3]));
    const auto way_mm =
        in_wrist_mm(mesh, glm::vec3(mesh.rest[next_joint(joint)][3])) - bone.begin_mm;
    bone.along_by_mm = way_mm / std::max(glm::dot(way_mm, way_mm), 1e-6f);
  }
  return bones;
}

glm::vec4 HandView::on_bone(const SurfaceTexel& texel, float edge_px) const {
  const auto ruling = [&](std::size_t corner) { return ruling_[texel.corners[corner]]; };
  const bool is_clear = ruling(0) >= 0 && ruling(0) == ruling(1) && ruling(0) == ruling(2);
  const int joint = is_clear ? ruling(0) : strongest_joint(*meshes_[0], texel);
  const auto& bone = bones_[static_cast<std::size_t>(joint)];
  const float along = glm::dot(texel.of<glm::vec3>(rest_mm_) - bone.begin_mm, bone.along_by_mm);
  return {static_cast<float>(joint), edge_px, std::clamp(along, 0.f, 1.f), 1};
}

/// Draws a map into scratch_, row 0 at the bottom.
void HandView::draw_map(std::size_t index, const Layout& layout, const HandState& hand) {
  const MapKind kind = kind_of(samplers_[index]);
  const auto place = [&](std::uint32_t texel) -> glm::vec4& {
    const auto width = static_cast<std::uint32_t>(layout.width),
               row = static_cast<std::uint32_t>(layout.height) - 1 - texel / width;
    return scratch_[row * width + texel % width];
  };
  const auto facing = [&](const SurfaceTexel& texel) {
    return facing_[meshes_[0]->chart[texel.corners[0]]];
  };
  for (const auto& texel : layout.surface->texels()) {
    glm::vec4& out = place(texel.index);
    if (kind == kRest) out = at_rest(texel);
    if (kind == kBone) out = on_bone(texel, layout.edge_px[texel.index]);
    if (kind == kPosition) out = glm::vec4(texel.of(hand.positions_m), facing(texel));
    if (kind == kNormal) out = glm::vec4(glm::normalize(texel.of(hand.normals)), facing(texel));
  }
  for (const auto& beside : layout.beside) {
    glm::vec4& out = place(beside.to);
    out = place(beside.from);
    if (kind == kBone) out.y = -beside.distance_px;
  }
}

void HandView::update(Graphics& graphics, const Moment& moment) {
  for (std::size_t i = 0; i < samplers_.size(); ++i) {
    Texels& image = images_[i];
    const bool is_live = is_live_map(kind_of(samplers_[i]));
    const auto& layout = is_live ? live_ : at_rest_;
    const bool is_possible = layout && (!is_live || !moment.hand->positions_m.empty());
    if (image.width > 0 && (!is_live || !is_possible)) continue;
    const int width = layout ? layout->width : 1, height = layout ? layout->height : 1;
    if (image.width == 0) image = graphics.make_texels(GL_RGBA32F, width, height);
    scratch_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                    glm::vec4(0));
    if (is_possible) draw_map(i, *layout, *moment.hand);
    graphics.functions().TextureSubImage2D(image.image.name(), 0, 0, 0, width, height, GL_RGBA,
                                           GL_FLOAT, scratch_.data());
  }
}

std::vector<const Texels*> HandView::images() const {
  std::vector<const Texels*> all;
  for (const auto& image : images_) all.push_back(&image);
  return all;
}

void HandView::set_hand(const UserProgram& program, const std::string& prefix,
                        const HandState& hand, const Places& places) const {
  program.set(prefix + "there", hand.is_there ? 1 : 0);
  program.set(prefix + "joint", std::span<const glm::vec3>(hand.joints_m));
  program.set(prefix + "rest_joint", std::span<const glm::vec3>(places.rest_mm));
  program.set(prefix + "palm_uv", std::span<const glm::vec2>(places.palm_uv));
  program.set(prefix + "back_uv", std::span<const glm::vec2>(places.back_uv));
  program.set(prefix + "pinch", hand.pinch);
  program.set(prefix + "spread", hand.spread);
  program.set(prefix + "curl", hand.curl);
  program.set(prefix + "speed", glm::length(hand.velocity_m_s));
  program.set(prefix + "normal", hand.palm_normal);
  program.set(prefix + "gravity", hand.gravity);
}

void HandView::set(const UserProgram& program, const Moment& moment) const {
  const int side = static_cast<int>(side_);
  set_hand(program, "hand_", *moment.hand, places_[0]);
  set_hand(program, "other_", *moment.other, places_[1]);
  program.set("hand_side", side);
  program.set("other_side", 1 - side);
}

}  // namespace handcast::content::shader
