// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/flesh.hpp"

#include <glm/glm.hpp>

#include "services/lab/training/pose.hpp"
#include "services/lab/twin/ground_truth_mesh.hpp"
#include "services/lab/twin/surface.hpp"

namespace handcast::landmarks::training {
namespace {

using renderer::HandMesh;

/// A point in millimetres and its normal, in the axes of a joint at rest.
struct Seen {
  glm::vec3 place_mm, normal;
};

Seen seen_from(const HandMesh& mesh, int joint, std::size_t vertex) {
  const glm::mat4 joint_from_model = glm::inverse(mesh.rest[joint]);
  return {glm::vec3(joint_from_model * glm::vec4(mesh.positions[vertex], 1)) * 1e3f,
          glm::mat3(joint_from_model) * mesh.normals[vertex]};
}

Skin skin_at(const HandMesh& mesh, std::size_t vertex) {
  for (int finger = 0; finger < 5; ++finger) {
    const Seen tip = seen_from(mesh, kTip[finger], vertex);
    const glm::vec3 p = tip.place_mm;
    if (tip.normal.y > 0.45f && p.z > -2 && p.z < 13 && std::abs(p.x) < 8 && std::abs(p.y) < 14)
      return Skin::nail;
    for (int joint = kFirstPhalanx[finger] + 1; joint < kTip[finger]; ++joint) {
      const Seen bent = seen_from(mesh, joint, vertex);
      if (std::abs(bent.place_mm.z) > 5 || std::abs(bent.place_mm.x) > 12 ||
          std::abs(bent.place_mm.y) > 14)
        continue;
      if (bent.normal.y > 0.4f) return Skin::knuckle;
      if (bent.normal.y < -0.4f) return Skin::crease;
    }
  }
  return Skin::plain;
}

const FleshModel& implicit_model() {
  static const FleshModel model([] {
    HandMesh right;
    right.side = renderer::Side::right;
    return twin::load_ground_truth_mesh("implicit", right)->mesh;
  }());
  return model;
}

float breadth_m(const renderer::JointFrames& rest) {
  return glm::distance(glm::vec3(rest[kFirstPhalanx[1]][3]), glm::vec3(rest[kFirstPhalanx[4]][3]));
}

/// Differences from a model, about as large as people's.
twin::Flesh draw_differences(Dice& dice) {
  config::TwinShape spread;
  spread.bone_width_spread = spread.taper_spread = 0.1;
  spread.thickness_spread = 0.14;
  spread.roll_deg = 9;
  spread.bulge = dice.between(0, 0.3f);
  return twin::Flesh::draw(spread, static_cast<int>(dice.bits() >> 33));
}

config::TwinSkinning draw_skinning(Dice& dice) {
  return dice.chance(0.5f) ? config::TwinSkinning::linear : config::TwinSkinning::dual_quaternion;
}

}  // namespace

FleshModel::FleshModel(HandMesh surface)
    : mesh(std::move(surface)), behind_m(twin::behind_wrist_m(mesh)) {
  skin.reserve(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) skin.push_back(skin_at(mesh, v));
}

Flesh draw_flesh(Dice& dice, const FleshModel& own) {
  const float kind = dice.uniform();
  if (kind < 0.2f) return {&own, {own.mesh, config::TwinSkinning::linear, {}, {}}};
  const bool is_own = kind < 0.5f;
  const FleshModel& model = is_own ? own : implicit_model();
  const float size =
      is_own ? 1 : (1 + dice.normal(0.08f)) * breadth_m(own.mesh.rest) / breadth_m(model.mesh.rest);
  return {&model, twin::flesh_on_bones(model.mesh, own.mesh.rest, size, draw_differences(dice),
                                       draw_skinning(dice))};
}

}  // namespace handcast::landmarks::training
