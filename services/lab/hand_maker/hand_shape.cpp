// SPDX-License-Identifier: Apache-2.0
#include "services/lab/hand_maker/hand_shape.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "services/lab/hand_maker/rest_pose.hpp"

namespace handcast::renderer {
namespace {

glm::dmat3 rotation(double degrees, const glm::dvec3& axis) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(degrees), axis));
}

/// Axes of a bone from `from` to `to` whose back faces `dorsal` as nearly as possible.
glm::dmat3 bone_axes(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& dorsal) {
  const glm::dvec3 proximal = glm::normalize(from - to);
  const glm::dvec3 back = glm::normalize(dorsal - proximal * glm::dot(dorsal, proximal));
  return {glm::cross(back, proximal), back, proximal};
}

void place_finger(RestPose& rest, const HandShape& shape, int finger) {
  const bool thumb = finger == 0;
  const int metacarpal = kMetacarpal[finger];
  rest.position_mm[metacarpal] = shape.metacarpal_mm[finger];
  rest.position_mm[metacarpal + 1] = shape.proximal_mm[finger];
  const glm::dvec3 dorsal = thumb ? glm::dvec3(0.62, 0.78, -0.05) : glm::dvec3(0, 1, 0);
  rest.axes[metacarpal] = bone_axes(shape.metacarpal_mm[finger], shape.proximal_mm[finger], dorsal);

  glm::dmat3 axes = thumb ? rest.axes[metacarpal] : rotation(-shape.splay_deg[finger], {0, 1, 0});
  for (int k = 0; k < phalanx_count(finger); ++k) {
    const int joint = metacarpal + 1 + k;
    axes = axes * rotation(-shape.flexion_deg[finger][k], {1, 0, 0});
    rest.axes[joint] = axes;
    rest.position_mm[joint + 1] =
        rest.position_mm[joint] - axes[2] * double(shape.phalanx_mm[finger][k]);
  }
  rest.axes[tip_of(finger)] = axes;
}

}  // namespace

HandShape HandShape::mean() {
  HandShape shape;
  shape.metacarpal_mm = {{{23, -11, -20}, {15, 3, -24}, {4, 4, -25}, {-6, 3, -24}, {-14, 0, -23}}};
  shape.proximal_mm = {
      {{48, -25, -51}, {29, 2, -86}, {8.5f, 4, -89}, {-11.5f, 2, -84}, {-29, -2, -74}}};
  shape.phalanx_mm = {{{32, 27, 0}, {41, 24, 22}, {45, 28, 23}, {42, 26.5f, 22.5f}, {33, 19, 20}}};
  shape.splay_deg = {0, 8, 1.5f, -5.5f, -14};
  shape.flexion_deg = {{{12, 10, 0}, {5, 8, 5}, {5, 8, 5}, {5, 8, 5}, {5, 8, 5}}};
  shape.radius_mm = {{{13, 10.6f, 10.2f, 8.4f},
                      {10.4f, 9.2f, 8, 7},
                      {10.6f, 9.5f, 8.2f, 7.1f},
                      {10.1f, 8.9f, 7.8f, 6.8f},
                      {8.8f, 7.8f, 6.9f, 6.1f}}};
  return shape;
}

HandShape HandShape::scaled(const std::array<float, 5>& length, float palm, float width) const {
  HandShape shape = *this;
  for (int f = 0; f < kFingers; ++f) {
    shape.metacarpal_mm[f] *= palm;
    shape.proximal_mm[f] *= palm;
    for (float& phalanx : shape.phalanx_mm[f]) phalanx *= length[f];
    for (float& radius : shape.radius_mm[f]) radius *= width;
  }
  shape.palm_half_thickness_mm *= width;
  shape.wrist_half_axes_mm *= width;
  return shape;
}

RestPose rest_pose(const HandShape& shape) {
  RestPose rest;
  rest.axes.fill(glm::dmat3(1));
  for (int f = 0; f < kFingers; ++f) place_finger(rest, shape, f);
  const int middle = kMetacarpal[2];
  rest.position_mm[0] = (rest.position_mm[middle] + rest.position_mm[middle + 1]) * 0.5;
  return rest;
}

JointFrames rest_frames(const HandShape& shape) {
  const RestPose rest = rest_pose(shape);
  JointFrames frames;
  for (int j = 0; j < kJoints; ++j) {
    frames[j] = glm::mat4(glm::mat3(rest.axes[j]));
    frames[j][3] = glm::vec4(glm::vec3(rest.position_mm[j] * 1e-3), 1);
  }
  return frames;
}

std::array<float, kJoints> joint_radii_m(const HandShape& shape) {
  std::array<float, kJoints> radius_m{};
  radius_m[0] = shape.palm_half_thickness_mm * 1e-3f;
  radius_m[1] = shape.wrist_half_axes_mm.y * 1e-3f;
  for (int f = 0; f < kFingers; ++f) {
    const int first = f == 0 ? kMetacarpal[f] : kMetacarpal[f] + 1;
    radius_m[kMetacarpal[f]] = shape.palm_half_thickness_mm * 1e-3f;
    for (int k = 0; k < 4; ++k) radius_m[first + k] = shape.radius_mm[f][k] * 1e-3f;
  }
  return radius_m;
}

}  // namespace handcast::renderer
