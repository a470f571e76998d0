// SPDX-License-Identifier: Apache-2.0
#include "services/landmarks/training/people.hpp"

#include <limits>

#include "services/evaluation/twin/surface.hpp"

namespace handcast::landmarks::training {
namespace {

using renderer::HandMesh;
using renderer::HandShape;

glm::vec3 draw_shift(Dice& dice, float deviation_mm) {
  return {dice.normal(deviation_mm), dice.normal(deviation_mm), dice.normal(deviation_mm)};
}

/// Varies the lengths of a hand and the places of its joints: trackers define wrist, root of the
/// thumb and knuckles at places that differ by up to a centimetre.
HandShape draw_shape(Dice& dice) {
  HandShape shape = HandShape::mean();
  std::array<float, 5> length;
  const float fingers = 1 + dice.normal(0.07f);
  for (float& finger : length) finger = fingers * (1 + dice.normal(0.045f));
  shape = shape.scaled(length, 1 + dice.normal(0.06f), std::exp(dice.normal(0.1f)));
  const float last = 1 + dice.normal(0.08f), breadth = 1 + dice.normal(0.05f);
  const glm::vec3 from_wrist = draw_shift(dice, 4), knuckles = draw_shift(dice, 3);
  for (int finger = 0; finger < 5; ++finger) {
    shape.phalanx_mm[finger][finger == 0 ? 1 : 2] *= last;
    const float width = 1 + dice.normal(0.04f);
    for (float& radius : shape.radius_mm[finger]) radius *= width * (1 + dice.normal(0.02f));
    shape.proximal_mm[finger].x *= breadth;
    shape.metacarpal_mm[finger] += from_wrist;
    shape.proximal_mm[finger] += from_wrist;
    if (finger > 0) shape.proximal_mm[finger] += knuckles;
  }
  shape.metacarpal_mm[0] += draw_shift(dice, 4);
  shape.proximal_mm[0] += draw_shift(dice, 3);
  return shape;
}

/// Moves the joints in the flesh, whose tips stay: rigs and trackers disagree by up to a
/// centimetre, most of all along the fingers. The wrist moves by `wrist_mm`.
HandShape with_other_joints(Dice& dice, HandShape shape, const glm::vec3& wrist_mm) {
  const auto rest = renderer::rest_frames(shape);
  const float along_mm = dice.normal(5.5f), breadth = 1 + dice.normal(0.05f),
              deep_mm = dice.normal(1.5f);
  for (int finger = 0; finger < 5; ++finger) {
    const bool thumb = finger == 0;
    const float knuckle_mm = (thumb ? 0.4f : 1.0f) * along_mm + dice.normal(1.5f),
                middle_mm = 0.7f * knuckle_mm + dice.normal(1.2f),
                last_mm = thumb ? 0 : 0.4f * knuckle_mm + dice.normal(1);
    const glm::vec3 to_tip = -glm::vec3(rest[kFirstPhalanx[finger]][2]);
    shape.metacarpal_mm[finger] -= wrist_mm;
    if (thumb) shape.metacarpal_mm[finger] += draw_shift(dice, 3);
    shape.proximal_mm[finger].x *= breadth;
    shape.proximal_mm[finger] += knuckle_mm * to_tip - wrist_mm;
    shape.proximal_mm[finger].y += deep_mm;
    shape.phalanx_mm[finger][0] += middle_mm - knuckle_mm;
    shape.phalanx_mm[finger][1] += last_mm - middle_mm;
    if (!thumb) shape.phalanx_mm[finger][2] -= last_mm;
  }
  return shape;
}

/// Lets the flesh follow the joints of another hand of the same size, whose wrist is `wrist_mm`
/// away in the axes of a left hand: each vertex as the nearest one there that faces the same way.
void put_on_joints_of(const HandMesh& other, glm::vec3 wrist_mm, HandMesh& flesh) {
  wrist_mm.x = -wrist_mm.x;  // a right hand
  for (std::size_t v = 0; v < flesh.vertex_count(); ++v) {
    flesh.positions[v] -= 1e-3f * wrist_mm;
    std::size_t nearest = v;
    float least = std::numeric_limits<float>::max();
    for (std::size_t u = 0; u < other.vertex_count(); ++u) {
      const glm::vec3 away = other.positions[u] - flesh.positions[v];
      const float far = glm::dot(away, away);
      if (far >= least || glm::dot(other.normals[u], flesh.normals[v]) < 0) continue;
      least = far;
      nearest = u;
    }
    flesh.joints[v] = other.joints[nearest];
    flesh.weights[v] = other.weights[nearest];
  }
  flesh.rest = other.rest;
}

/// Varies the flesh on the bones, so that the network does not take one mesh for all hands.
twin::TrueHand draw_flesh(Dice& dice, const HandMesh& mesh) {
  config::TwinShape varied;
  varied.bone_width_spread = varied.thickness_spread = varied.taper_spread = 0.15;
  varied.roll_deg = 7;
  varied.bulge = dice.between(0, 0.25f);
  varied.skinning =
      dice.chance(0.5f) ? config::TwinSkinning::linear : config::TwinSkinning::dual_quaternion;
  const auto flesh = twin::Flesh::draw(varied, static_cast<int>(dice.bits() >> 40));
  return twin::flesh_on_bones(mesh, mesh.rest, 1, flesh, varied.skinning);
}

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

}  // namespace

Result<std::vector<Person>> draw_people(int count, std::uint64_t seed) {
  const auto model = renderer::load_hand_or_default({}, renderer::Side::right);
  if (!model) return tl::make_unexpected(model.error());
  std::vector<Person> people;
  for (int i = 0; i < count; ++i) {
    Dice dice(seed ^ 0x70656f706c65, static_cast<std::uint64_t>(i));
    const HandShape flesh = draw_shape(dice);
    const glm::vec3 wrist_mm = draw_shift(dice, 4);
    const HandShape shape = with_other_joints(dice, flesh, wrist_mm);
    Person person{draw_flesh(dice, renderer::refit_hand(*model, flesh)),
                  twin::Articulation(shape),
                  renderer::joint_radii_m(shape),
                  {},
                  {}};
    for (std::size_t v = 0; v < person.hand.mesh.vertex_count(); ++v)
      person.skin.push_back(skin_at(person.hand.mesh, v));
    put_on_joints_of(renderer::refit_hand(*model, shape), wrist_mm, person.hand.mesh);
    person.behind_m = twin::behind_wrist_m(person.hand.mesh);
    people.push_back(std::move(person));
  }
  return people;
}

}  // namespace handcast::landmarks::training
