// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/finger_pose.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace handcast::twin {
namespace {

constexpr int kIndexKnuckle = 7, kMiddleKnuckle = 12, kLittleKnuckle = 22;
constexpr int kIndexPip = 8, kMiddlePip = 13, kFromPipToTip = 3;

glm::dmat4 rigid_inverse(const glm::dmat4& m) {
  glm::dmat4 inverse(glm::transpose(glm::dmat3(m)));
  inverse[3] = glm::dvec4(-(glm::dmat3(inverse) * glm::dvec3(m[3])), 1);
  return inverse;
}

/// Angle of the next bone, -z of `joint`, below -z of `parent`.
double flexion_between(const glm::mat4& parent, const glm::mat4& joint) {
  const glm::dvec3 bone = glm::transpose(glm::dmat3(parent)) * -glm::dvec3(joint[2]);
  return std::atan2(-bone.y, -bone.z);
}

glm::mat4 mean_of(const glm::mat4& a, const glm::mat4& b) {
  glm::mat4 mean(glm::mat4_cast(glm::slerp(glm::quat_cast(a), glm::quat_cast(b), 0.5f)));
  mean[3] = 0.5f * (a[3] + b[3]);
  return mean;
}

float distance_in(const JointFrames& frames, int from, int to) {
  return glm::distance(joint_position(frames, from), joint_position(frames, to));
}

/// Turns a frame by the smallest angle so that its -z points to `end`.
void aim_at(const glm::vec3& end, glm::mat4& frame) {
  const glm::vec3 from = -glm::normalize(glm::vec3(frame[2])), way = end - glm::vec3(frame[3]);
  const glm::vec4 start = frame[3];
  frame = glm::mat4_cast(glm::quat(from, glm::normalize(way))) * frame;
  frame[3] = start;
}

}  // namespace

/// The right hand is the mirror image in x of the left one: S m S with S = diag(-1, 1, 1, 1).
JointFrames mirrored(JointFrames frames) {
  for (auto& frame : frames)
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r)
        if ((c == 0) != (r == 0)) frame[c][r] = -frame[c][r];
  return frames;
}

JointFrames rest_pose(renderer::Side side, const renderer::HandShape& person) {
  const JointFrames rest = renderer::rest_frames(person);
  return side == renderer::Side::left ? rest : mirrored(rest);
}

Flexion flexion_of(const JointFrames& frames) {
  Flexion flexion{};
  for (int f = 0; f < kFingers; ++f)
    for (int i = 0; i < bends_of(f); ++i) {
      const int joint = bend_joint(f, i);
      flexion[f][i] = flexion_between(frames[joint - 1], frames[joint]);
    }
  return flexion;
}

JointFrames bent_by(const JointFrames& frames, const Flexion& more) {
  JointFrames bent = frames;
  for (int f = 0; f < kFingers; ++f) {
    glm::dmat4 moved(1);  // takes the true finger beyond the joint to the bent one
    for (int i = 0; i < bends_of(f); ++i) {
      const glm::dmat4 joint(frames[bend_joint(f, i)]);
      const glm::dmat4 now = moved * glm::rotate(joint, -more[f][i], {1, 0, 0});
      bent[bend_joint(f, i)] = glm::mat4(now);
      moved = now * rigid_inverse(joint);
    }
    bent[tip_joint(f)] = glm::mat4(moved * glm::dmat4(frames[tip_joint(f)]));
  }
  return bent;
}

JointFrames nearer_to(const JointFrames& frames, const JointFrames& rest, double share) {
  JointFrames nearer = frames;
  for (int j = 0; j < kJoints; ++j) {
    const int parent = renderer::kJointParent[j];
    if (j == kWristJoint || parent < 0) continue;
    const glm::dmat4 now = rigid_inverse(glm::dmat4(frames[parent])) * glm::dmat4(frames[j]);
    const glm::dmat3 then = glm::transpose(glm::dmat3(rest[parent])) * glm::dmat3(rest[j]);
    glm::dmat4 local(
        glm::mat4_cast(glm::slerp(glm::quat_cast(glm::dmat3(now)), glm::quat_cast(then), share)));
    local[3] = now[3];
    nearer[j] = glm::mat4(glm::dmat4(nearer[parent]) * local);
  }
  return nearer;
}

glm::mat3 palm_axes(const JointFrames& frames) {
  const glm::vec3 length = glm::normalize(joint_position(frames, kMiddleKnuckle) -
                                          joint_position(frames, kWristJoint)),
                  across = joint_position(frames, kIndexKnuckle) -
                           joint_position(frames, kLittleKnuckle),
                  side = glm::normalize(across - glm::dot(across, length) * length);
  return {side, glm::cross(length, side), length};
}

JointFrames with_bones_of(const JointFrames& rest, const JointFrames& frames) {
  JointFrames result = frames;
  const glm::mat4 posed_from_rest = frames[kWristJoint] * glm::inverse(rest[kWristJoint]);
  const auto put = [&](int joint, int seen_from, int from) {
    const glm::vec3 way = joint_position(frames, joint) - joint_position(frames, seen_from);
    const glm::vec3 at =
        joint_position(result, from) + distance_in(rest, from, joint) * glm::normalize(way);
    result[joint][3] = glm::vec4(at, 1);
  };
  for (int f = 0; f < kFingers; ++f) {
    const int base = kMetacarpalJoint[f], knuckle = base + 1;
    result[base][3] = posed_from_rest * rest[base][3];
    const int fixed = f == 0 ? base : kWristJoint;
    put(knuckle, fixed, fixed);
    for (int joint = knuckle + 1; joint <= tip_joint(f); ++joint) put(joint, joint - 1, joint - 1);
    for (int joint = base; joint < tip_joint(f); ++joint)
      aim_at(joint_position(result, joint + 1), result[joint]);
  }
  result[0][3] = posed_from_rest * rest[0][3];
  return result;
}

JointFrames merged(const JointFrames& frames) {
  JointFrames one = frames;
  for (int i = 0; i < kFromPipToTip; ++i)
    one[kIndexPip + i] = one[kMiddlePip + i] =
        mean_of(frames[kIndexPip + i], frames[kMiddlePip + i]);
  return one;
}

}  // namespace handcast::twin
