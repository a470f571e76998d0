// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "renderer/skin/skinning.hpp"
#include "services/lab/twin/finger_pose.hpp"
#include "services/lab/twin/random.hpp"
#include "services/lab/twin/true_hands.hpp"

namespace handcast::twin {
namespace {

using renderer::HandMesh;

bool is_tip(int joint) {
  for (int f = 0; f < kFingers; ++f)
    if (joint == tip_joint(f)) return true;
  return false;
}

/// The joint at the far end of a bone; -1 at a tip, in the wrist and in the palm.
int far_end(int joint) { return joint <= kWristJoint || is_tip(joint) ? -1 : joint + 1; }

/// The rotation by the smallest angle that turns one direction into another.
glm::mat3 shortest_turn(const glm::vec3& from, const glm::vec3& to) {
  return glm::mat3_cast(glm::quat(glm::normalize(from), glm::normalize(to)));
}

/// Maps the flesh of a model to a person, one affine map per bone.
class BoneMaps {
 public:
  BoneMaps(const HandMesh& model, const JointFrames& rest, float size, const Flesh& flesh)
      : model_(model), rest_(rest), size_(size), flesh_(flesh) {
    turn_ = palm_axes(rest) * glm::transpose(palm_axes(model.rest));
    for (int j = 0; j < msg::kJoints; ++j) maps_[j] = map_of(j);
  }

  /// The frames with which renderer::skin() applies the maps.
  JointFrames frames() const {
    JointFrames frames;
    for (int j = 0; j < msg::kJoints; ++j) frames[j] = maps_[j] * model_.rest[j];
    return frames;
  }

 private:
  glm::mat4 map_of(int joint) const {
    const int end = far_end(joint);
    if (end < 0 && joint > kWristJoint) return maps_[joint - 1];  // a tip goes with its phalanx
    glm::vec3 direction = -glm::vec3(rest_[joint][2]);
    glm::mat3 turn = turn_;
    float stretch = size_;
    if (end >= 0) {
      const glm::vec3 from =
          turn_ * (joint_position(model_.rest, end) - joint_position(model_.rest, joint));
      direction = joint_position(rest_, end) - joint_position(rest_, joint);
      turn = shortest_turn(from, direction) * turn_;
      stretch = glm::length(direction) / length_of_model(joint, end);
    }
    const glm::mat3 shape = scaled(joint, glm::normalize(direction), stretch) * turn;
    return glm::translate(glm::mat4(1), joint_position(rest_, joint)) * glm::mat4(shape) *
           glm::translate(glm::mat4(1), -joint_position(model_.rest, joint));
  }

  /// The length of a bone of the model; of a last phalanx, to the skin of the tip.
  float length_of_model(int joint, int end) const {
    const glm::vec3 from = joint_position(model_.rest, joint),
                    to = joint_position(model_.rest, end);
    const float length = glm::distance(from, to);
    if (!is_tip(end)) return length;
    const glm::vec3 along = (to - from) / length;
    float skin = 0;
    for (std::size_t v = 0; v < model_.vertex_count(); ++v)
      if (moves_with(v, joint)) skin = std::max(skin, glm::dot(model_.positions[v] - from, along));
    return skin > 0 ? skin : length;
  }

  /// True if a vertex is mostly of the phalanx `joint` or of the tip behind it.
  bool moves_with(std::size_t v, int joint) const {
    float share = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (model_.joints[v][k] == joint || model_.joints[v][k] == joint + 1)
        share += model_.weights[v][k];
    return share > 0.5f;
  }

  /// Scales along the bone and across it, and turns about it.
  glm::mat3 scaled(int joint, const glm::vec3& along, float stretch) const {
    const auto j = static_cast<std::size_t>(joint);
    const int finger = finger_of_joint(joint);
    const glm::vec3 back(rest_[j][1]);
    const glm::vec3 dorsal = glm::normalize(back - glm::dot(back, along) * along);
    const glm::mat3 axes(glm::cross(dorsal, along), dorsal, along);
    const float width = size_ * flesh_.width[j];
    const glm::mat3 size(width, 0, 0, 0, width * flesh_.thickness[j], 0, 0, 0, stretch);
    const float roll = finger < 0 ? 0 : flesh_.roll_rad[static_cast<std::size_t>(finger)];
    return glm::mat3(glm::rotate(glm::mat4(1), roll, along)) * axes * size * glm::transpose(axes);
  }

  const HandMesh& model_;
  const JointFrames& rest_;
  float size_;
  const Flesh& flesh_;
  glm::mat3 turn_;
  std::array<glm::mat4, msg::kJoints> maps_;
};

/// Finds the vertices that bulge: on the inside of the joint between two phalanges.
void add_bulges(TrueHand& hand, float bulge) {
  if (bulge <= 0) return;
  const HandMesh& mesh = hand.mesh;
  hand.bulge_joint.assign(mesh.vertex_count(), 0);
  hand.bulge_m.assign(mesh.vertex_count(), 0.0f);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    std::array<float, msg::kJoints> weight{};
    for (std::size_t k = 0; k < 4; ++k) weight[mesh.joints[v][k]] += mesh.weights[v][k];
    for (int j = bend_joint(0, 0); j < msg::kJoints; ++j) {
      if (finger_of_joint(j) < 0 || far_end(j) < 0) continue;
      const float between = 4 * weight[j] * weight[renderer::kJointParent[j]];
      const float inside = -glm::dot(mesh.normals[v], glm::vec3(mesh.rest[j][1]));
      const glm::vec3 away = mesh.positions[v] - joint_position(mesh.rest, j);
      const float far_m = bulge * between * std::max(inside, 0.0f) * glm::length(away);
      if (far_m <= hand.bulge_m[v]) continue;
      hand.bulge_m[v] = far_m;
      hand.bulge_joint[v] = static_cast<std::uint8_t>(j);
    }
  }
}

}  // namespace

Flesh Flesh::of_model() {
  Flesh flesh;
  flesh.width.fill(1);
  flesh.thickness.fill(1);
  return flesh;
}

Flesh Flesh::draw(const config::TwinShape& settings, int seed) {
  constexpr std::uint64_t kThickness = 100, kTaper = 200, kRoll = 300;
  const Random random(seed, Stream::flesh);
  const auto factor = [&](double spread, std::uint64_t draw) {
    return static_cast<float>(1 + spread * random.spread(draw));
  };
  Flesh flesh = of_model();
  const float palm_thickness = factor(settings.thickness_spread, kThickness);
  flesh.thickness.fill(palm_thickness);
  for (int f = 0; f < kFingers; ++f) {
    const auto finger = static_cast<std::uint64_t>(f);
    const float thickness = factor(settings.thickness_spread, kThickness + 1 + finger),
                taper = factor(settings.taper_spread, kTaper + finger);
    const int first = bend_joint(f, 0), tip = tip_joint(f);
    for (int j = first; j <= tip; ++j) {
      const auto part = static_cast<float>(j - first) / static_cast<float>(tip - first);
      flesh.thickness[j] = thickness;
      flesh.width[j] = factor(settings.bone_width_spread, static_cast<std::uint64_t>(j)) *
                       glm::mix(1.0f, taper, part);
    }
    flesh.roll_rad[f] =
        static_cast<float>(glm::radians(settings.roll_deg) * random.normal(kRoll + finger));
  }
  flesh.bulge = static_cast<float>(settings.bulge);
  return flesh;
}

TrueHand flesh_on_bones(const HandMesh& model, const JointFrames& rest, float size,
                        const Flesh& flesh, config::TwinSkinning skinning) {
  TrueHand hand{model, skinning, {}, {}};
  const BoneMaps maps(model, rest, size, flesh);
  renderer::skin(model, maps.frames(), hand.mesh.positions, hand.mesh.normals);
  hand.mesh.rest = rest;
  add_bulges(hand, flesh.bulge);
  return hand;
}

}  // namespace handcast::twin
