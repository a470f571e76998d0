// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/people.hpp"

#include "services/lab/twin/surface.hpp"

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
    const HandShape shape = draw_shape(dice);
    Person person{renderer::refit_hand(*model, shape),
                  twin::Articulation(shape),
                  renderer::joint_radii_m(shape),
                  {},
                  {}};
    person.behind_m = twin::behind_wrist_m(person.mesh);
    for (std::size_t v = 0; v < person.mesh.vertex_count(); ++v)
      person.skin.push_back(skin_at(person.mesh, v));
    people.push_back(std::move(person));
  }
  return people;
}

}  // namespace handcast::landmarks::training
