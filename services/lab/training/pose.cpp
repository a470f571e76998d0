// SPDX-License-Identifier: Apache-2.0
#include "services/lab/training/pose.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace handcast::landmarks::training {
namespace {

using renderer::HandShape;

glm::vec3 draw_shift(Dice& dice, float deviation) {
  return {dice.normal(deviation), dice.normal(deviation), dice.normal(deviation)};
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

}  // namespace

Result<std::vector<Person>> draw_people(int count, std::uint64_t seed) {
  const auto model = renderer::load_hand_or_default({}, renderer::Side::right);
  if (!model) return tl::make_unexpected(model.error());
  std::vector<Person> people;
  for (int i = 0; i < count; ++i) {
    Dice dice(seed ^ 0x70656f706c65, static_cast<std::uint64_t>(i));
    const HandShape shape = draw_shape(dice);
    people.push_back({FleshModel(renderer::refit_hand(*model, shape)), twin::Articulation(shape),
                      renderer::joint_radii_m(shape)});
  }
  return people;
}

namespace {

using renderer::JointFrames;
using twin::Bend;

constexpr float kFlesh = 0.6f;  ///< least distance of two parts, as a fraction of their radii's sum
constexpr int kPerPhalanx = 3;

struct Ball {
  glm::vec3 centre;
  float radius_m;
};

glm::vec3 place(const JointFrames& joints, int joint) { return glm::vec3(joints[joint][3]); }

/// Adds balls from a joint to the next one.
void add_bone(const Person& person, const JointFrames& joints, int joint,
              std::vector<Ball>& balls) {
  for (int i = 0; i < kPerPhalanx; ++i) {
    const float along = static_cast<float>(i) / kPerPhalanx;
    balls.push_back({glm::mix(place(joints, joint), place(joints, joint + 1), along),
                     glm::mix(person.radius_m[joint], person.radius_m[joint + 1], along)});
  }
}

bool meet(std::span<const Ball> one, std::span<const Ball> other) {
  for (const Ball& a : one)
    for (const Ball& b : other) {
      const float apart = kFlesh * (a.radius_m + b.radius_m);
      const glm::vec3 way = a.centre - b.centre;
      if (glm::dot(way, way) < apart * apart) return true;
    }
  return false;
}

void curl(Dice& dice, Bend& bend, int finger, float amount) {
  bend.flexion[finger] = {1.35f * amount - 0.12f + dice.normal(0.09f),
                          1.65f * amount + dice.normal(0.07f), 0.95f * amount + dice.normal(0.06f)};
}

/// Bends each joint independently, except the last one, which follows the middle one.
void bend_freely(Dice& dice, Bend& bend, int finger) {
  const float middle = dice.between(-0.05f, 1.75f);
  bend.flexion[finger] = {dice.between(-0.35f, 1.5f), middle,
                          std::clamp(0.55f * middle + dice.normal(0.2f), -0.1f, 1.2f)};
}

void place_thumb(Dice& dice, Bend& bend) {
  bend.thumb_flexion = dice.normal(0.22f);
  bend.thumb_opposition = dice.normal(0.24f);
  bend.thumb_roll = dice.normal(0.12f);
  bend.flexion[0] = {dice.between(-0.15f, 0.75f), dice.between(-0.25f, 1.15f), 0};
  bend.splay[0] = dice.normal(0.08f);
}

void lay_thumb_over(Dice& dice, Bend& bend) {
  bend.flexion[0] = {0.6f + dice.normal(0.15f), 0.9f + dice.normal(0.2f), 0};
  bend.thumb_flexion = 0.25f + dice.normal(0.12f);
  bend.thumb_opposition = -0.2f + dice.normal(0.12f);
}

float fingertip_gap_m(const JointFrames& joints, int finger) {
  return glm::distance(place(joints, kTip[0]), place(joints, kTip[finger]));
}

/// Brings the tips of thumb and finger together by random search.
void pinch(Dice& dice, const Person& person, Bend& bend, int finger) {
  bend.flexion[finger] = {dice.between(0.35f, 1.1f), dice.between(0.45f, 1.25f),
                          dice.between(0.15f, 0.7f)};
  const float wanted_m =
      dice.chance(0.7f) ? dice.between(0.012f, 0.018f) : dice.between(0.018f, 0.045f);
  float best = 1;
  for (int trial = 0; trial < 40; ++trial) {
    Bend next = bend;
    const float step = trial < 12 ? 0.4f : 0.12f;
    next.thumb_flexion = std::clamp<double>(next.thumb_flexion + dice.normal(step), -0.5, 0.8);
    next.thumb_opposition =
        std::clamp<double>(next.thumb_opposition + dice.normal(step), -0.6, 0.9);
    next.flexion[0][0] = std::clamp<double>(next.flexion[0][0] + dice.normal(step), -0.2, 0.9);
    next.flexion[0][1] = std::clamp<double>(next.flexion[0][1] + dice.normal(step), -0.2, 1.2);
    const float miss = std::abs(
        fingertip_gap_m(person.articulation.frames(renderer::Side::right, glm::dmat4(1), next),
                        finger) -
        wanted_m);
    if (miss >= best) continue;
    best = miss;
    bend = next;
    if (best < 0.003f) break;
  }
}

Bend draw_bend(Dice& dice, const Person& person) {
  enum Kind { relaxed, single_fingers, all_alike, fist, flat, pinching, pointing, gripping, free };
  constexpr std::array<float, 9> kShare{0.12f, 0.2f, 0.1f, 0.08f, 0.08f, 0.12f, 0.1f, 0.12f, 0.08f};
  int kind = 0;
  for (float at = dice.uniform(); kind < free && at >= kShare[kind]; ++kind) at -= kShare[kind];

  Bend bend;
  place_thumb(dice, bend);
  const float all = dice.between(0, 1.05f);
  for (int finger = 1; finger < 5; ++finger) {
    float amount = 0;
    if (kind == relaxed) amount = std::max(0.0f, 0.25f * all + dice.normal(0.12f));
    if (kind == single_fingers || kind == pinching) {
      const float way = dice.uniform();
      amount = way < 0.35f ? 0 : way < 0.65f ? dice.between(0.8f, 1.05f) : dice.uniform();
    }
    if (kind == all_alike) amount = std::clamp(all + dice.normal(0.08f), 0.0f, 1.05f);
    if (kind == fist) amount = dice.between(0.88f, 1.08f);
    if (kind == pointing) amount = finger == 1 ? dice.normal(0.06f) : dice.between(0.7f, 1.08f);
    if (kind == gripping) amount = std::clamp(0.35f + 0.4f * all + dice.normal(0.08f), 0.0f, 1.05f);
    if (kind == flat) amount = dice.normal(0.05f);
    curl(dice, bend, finger, amount);
    if (kind == free || (kind == single_fingers && dice.chance(0.15f)))
      bend_freely(dice, bend, finger);
    const float spread = kind == flat ? dice.between(-0.04f, 0.16f) : 0.05f * (1 - amount);
    bend.splay[finger] = (2.4f - static_cast<float>(finger)) * spread + dice.normal(0.07f);
  }
  if (kind == fist || kind == pointing ? dice.chance(0.75f)
                                       : kind == all_alike && all > 0.7f && dice.chance(0.5f))
    lay_thumb_over(dice, bend);
  if (kind == pinching) pinch(dice, person, bend, dice.chance(0.55f) ? 1 : 1 + dice.pick(4));
  return bend;
}

}  // namespace

Pose pose_of(const Person& person, const Posture& posture) {
  Pose pose{posture,
            person.articulation.frames(renderer::Side::right, glm::dmat4(1), posture.bend)};
  for (int finger = 1; finger < 5; ++finger) {
    const int first = kFirstPhalanx[finger];
    const glm::vec3 knuckle = place(pose.joints, first);
    const glm::vec3 along = glm::normalize(knuckle - place(pose.joints, first - 1));
    const glm::mat4 turn = glm::translate(
        glm::rotate(glm::translate(glm::mat4(1), knuckle), posture.roll[finger], along), -knuckle);
    for (int joint = first; joint <= kTip[finger]; ++joint)
      pose.joints[joint] = turn * pose.joints[joint];
  }
  return pose;
}

Definitions draw_definitions(Dice& dice) {
  Definitions definitions;
  for (auto& shift_m : definitions) shift_m = draw_shift(dice, 0.0012f);
  for (const int joint : {kWristJoint, kThumbRoot}) definitions[joint] = draw_shift(dice, 0.004f);
  return definitions;
}

JointFrames defined(JointFrames joints, const Definitions& definitions) {
  for (std::size_t j = 0; j < joints.size(); ++j)
    joints[j] = glm::translate(joints[j], definitions[j]);
  return joints;
}

bool penetrates(const Person& person, const JointFrames& joints) {
  std::array<std::vector<Ball>, 5> fingers;
  std::vector<Ball> palm;
  for (int finger = 0; finger < 5; ++finger) {
    const int first = kFirstPhalanx[finger];
    fingers[finger].reserve(kPerPhalanx * 3 + 1);
    for (int joint = first; joint < kTip[finger]; ++joint)
      add_bone(person, joints, joint, fingers[finger]);
    fingers[finger].push_back({place(joints, kTip[finger]), 0.8f * person.radius_m[kTip[finger]]});
    if (finger > 0) add_bone(person, joints, first - 1, palm);
  }
  // The roots of the fingers share their flesh: a finger counts from its middle phalanx, the thumb
  // from its last.
  const auto outer = [&](int finger) {
    return std::span<const Ball>(fingers[finger]).subspan(kPerPhalanx);
  };
  for (int a = 0; a < 5; ++a) {
    if (meet(outer(a).subspan(a == 0 ? 1 : kPerPhalanx), palm)) return true;
    for (int b = a + 1; b < 5; ++b)
      if (meet(outer(a), a == 0 ? std::span<const Ball>(fingers[b]).subspan(1) : outer(b)))
        return true;
  }
  return false;
}

Pose draw_pose(Dice& dice, const Person& person) {
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    Posture posture{draw_bend(dice, person)};
    const float all = dice.normal(0.14f);
    for (float& roll : posture.roll) roll = all + dice.normal(0.14f);
    const Pose pose = pose_of(person, posture);
    if (!penetrates(person, pose.joints)) return pose;
  }
  return pose_of(person, Posture{});
}

}  // namespace handcast::landmarks::training
