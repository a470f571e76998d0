// SPDX-License-Identifier: Apache-2.0
#include "renderer/skin/bone_fit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace handcast::renderer {
namespace {

constexpr int kPalm = 0, kWrist = 1;
constexpr int kRememberedSamples = 600;  ///< tracker samples, about five seconds
constexpr std::int64_t kForgetBones_ns = 1'000'000'000;
constexpr std::array<int, 4> kKnuckles{7, 12, 17, 22};  ///< proximal joints, index to little finger
constexpr float kLeastStretch = 0.5f,
                kMostStretch = 2.0f;  ///< limits of the stretch, against outliers
constexpr float kShortest_m = 1e-4f;

glm::vec3 origin(const glm::mat4& frame) { return glm::vec3(frame[3]); }

/// The joint at the far end of the bone that starts at `joint`; -1 if there is none. The joints of
/// a finger are consecutive.
int far_joint(int joint) {
  const int next = joint + 1;
  return joint > kWrist && next < kJoints && kJointParent[static_cast<std::size_t>(next)] == joint
             ? next
             : -1;
}

float bone_length(const JointFrames& frames, int joint) {
  return glm::distance(origin(frames[joint]), origin(frames[far_joint(joint)]));
}

/// The size of the posed skeleton relative to the one at rest, from the sums of all bone lengths.
float size_ratio(const JointFrames& rest, const JointFrames& posed) {
  float rest_m = 0, posed_m = 0;
  for (int joint = 0; joint < kJoints; ++joint) {
    if (far_joint(joint) < 0) continue;
    rest_m += bone_length(rest, joint);
    posed_m += bone_length(posed, joint);
  }
  return rest_m > kShortest_m ? std::clamp(posed_m / rest_m, kLeastStretch, kMostStretch) : 1.0f;
}

/// The smallest rotation from unit vector `from` to unit vector `to`.
glm::mat3 aim(const glm::vec3& from, const glm::vec3& to) {
  const float cosine = glm::dot(from, to);
  if (cosine < -0.99f) return glm::mat3(1);  // nearly opposite: the pose is not plausible
  const glm::vec3 axis = glm::cross(from, to);
  return glm::mat3_cast(glm::normalize(glm::quat(1 + cosine, axis.x, axis.y, axis.z)));
}

/// Scales by `along` in the direction `axis` (unit) and by `across` at right angles to it.
glm::mat3 stretch(const glm::vec3& axis, float along, float across) {
  return glm::mat3(across) + (along - across) * glm::outerProduct(axis, axis);
}

/// The two ends that the skin of a joint is fitted to.
struct Span {
  glm::vec3 start, end;
};

Span span(const JointFrames& frames, int start, int end) {
  return {origin(frames[start]), origin(frames[end])};
}

/// The rotation of a joint from rest to pose.
glm::mat3 turn_of(const JointFrames& rest, const JointFrames& posed, int joint) {
  return glm::mat3(posed[joint]) * glm::transpose(glm::mat3(rest[joint]));
}

/// Rotates and stretches a span at rest onto a posed one, and scales by `width` at right angles to
/// it.
glm::mat4 onto(const Span& rest, const Span& posed, const glm::mat3& turn, float width) {
  const glm::vec3 rest_way = rest.end - rest.start, posed_way = posed.end - posed.start;
  const float rest_m = glm::length(rest_way), posed_m = glm::length(posed_way);
  glm::mat3 whole = turn * width;
  if (rest_m > kShortest_m && posed_m > kShortest_m) {
    const glm::vec3 axis = rest_way / rest_m;
    whole = aim(turn * axis, posed_way / posed_m) * turn *
            stretch(axis, std::clamp(posed_m / rest_m, kLeastStretch, kMostStretch), width);
  }
  glm::mat4 posed_from_rest(whole);
  posed_from_rest[3] = glm::vec4(posed.start - whole * rest.start, 1);
  return posed_from_rest;
}

/// The axes of the palm: across the knuckles, out of the back, and from the wrist to the knuckles.
glm::mat3 palm_axes(const JointFrames& frames) {
  glm::vec3 middle(0);
  for (const int knuckle : kKnuckles) middle += 0.25f * origin(frames[knuckle]);
  const glm::vec3 length = glm::normalize(middle - origin(frames[kWrist])),
                  across = origin(frames[kKnuckles.front()]) - origin(frames[kKnuckles.back()]),
                  side = glm::normalize(across - glm::dot(across, length) * length);
  return {side, glm::cross(length, side), length};
}

/// The rotation of the palm from rest to pose, by its knuckles: trackers define the axes of the
/// wrist differently. If the palm is not plausible, that of the wrist's axes.
glm::mat3 palm_turn(const JointFrames& rest, const JointFrames& posed) {
  const glm::mat3 turn = palm_axes(posed) * glm::transpose(palm_axes(rest));
  return std::isfinite(turn[0].x + turn[1].x) ? turn : turn_of(rest, posed, kWrist);
}

bool is_finite(const JointFrames& frames) {
  float sum = 0;
  for (const glm::mat4& frame : frames)
    for (int column = 0; column < 4; ++column)
      sum += frame[column].x + frame[column].y + frame[column].z;
  return std::isfinite(sum);
}

}  // namespace

BoneFit::Person BoneFit::person_in(const JointFrames& posed) const {
  const glm::mat4 wrist_from_space = glm::inverse(posed[kWrist]);
  Person person;
  for (std::size_t finger = 0; finger < person.base.size(); ++finger) {
    person.base[finger] = glm::vec3(wrist_from_space * posed[kKnuckles[finger] - 1][3]);
    person.knuckle[finger] = glm::vec3(wrist_from_space * posed[kKnuckles[finger]][3]);
  }
  person.size = size_ratio(rest_, posed);
  return person;
}

void BoneFit::learn(std::int64_t origin_ns, const JointFrames& posed) {
  if (!is_finite(posed)) return;
  if (origin_ns - last_ns_ > kForgetBones_ns) learned_ = 0;
  last_ns_ = origin_ns;
  learned_ = std::min(learned_ + 1, kRememberedSamples);
  const Person seen = person_in(posed);
  const float share = 1 / static_cast<float>(learned_);
  for (std::size_t finger = 0; finger < seen.base.size(); ++finger) {
    person_.base[finger] += share * (seen.base[finger] - person_.base[finger]);
    person_.knuckle[finger] += share * (seen.knuckle[finger] - person_.knuckle[finger]);
  }
  person_.size += share * (seen.size - person_.size);
}

JointFrames BoneFit::operator()(const JointFrames& posed) const {
  const Person seen = person_in(posed);
  const Person& person = learned_ > 0 ? person_ : seen;
  const float finger_width = person.size * width_,
              palm_width = person.size * (1 + 0.5f * (width_ - 1));
  JointFrames fitted = posed;
  const auto reach = [&](int joint, const Span& to, float width) {
    fitted[joint] =
        onto(span(rest_, joint, joint + 1), to, turn_of(rest_, posed, joint), width) * rest_[joint];
  };
  for (int joint = kWrist + 1; joint < kJoints; ++joint)
    if (far_joint(joint) > 0) reach(joint, span(posed, joint, joint + 1), finger_width);
  for (std::size_t finger = 0; finger < seen.base.size(); ++finger) {
    const glm::mat4 seen_from_person = onto({glm::vec3(0), person.knuckle[finger]},
                                            {glm::vec3(0), seen.knuckle[finger]}, glm::mat3(1), 1);
    const glm::vec3 base(posed[kWrist] * seen_from_person * glm::vec4(person.base[finger], 1));
    reach(kKnuckles[finger] - 1, {base, origin(posed[kKnuckles[finger]])}, palm_width);
  }
  // Wrist and forearm rotate with the knuckles but are not stretched: they have no far joint.
  const glm::mat3 whole = palm_turn(rest_, posed) * palm_width;
  for (const int joint : {kPalm, kWrist}) {
    glm::mat4 posed_from_rest(whole);
    posed_from_rest[3] = glm::vec4(origin(posed[kWrist]) - whole * origin(rest_[kWrist]), 1);
    fitted[joint] = posed_from_rest * rest_[joint];
  }
  return fitted;
}

}  // namespace handcast::renderer
