// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/implicit/parts.hpp"

namespace handcast::twin {
namespace {

using renderer::HandShape;
using renderer::kMetacarpal;
using renderer::RestPose;

constexpr int kWrist = 1;
constexpr double kRigid = 1;  ///< a length: a part that one joint moves has nothing to blend

/// Axes along a direction whose back faces up.
glm::dmat3 axes_along(const glm::dvec3& direction) {
  const glm::dvec3 proximal = -glm::normalize(direction), up(0, 1, 0);
  const glm::dvec3 back = glm::normalize(up - proximal * glm::dot(up, proximal));
  return {glm::cross(back, proximal), back, proximal};
}

/// An ellipsoid that one joint moves, with its long axis along a direction.
Part ellipsoid(const glm::dvec3& middle, const glm::dvec3& along, const glm::dvec3& half_mm,
               int joint) {
  return {
      Limb(middle, axes_along(along), {{0, half_mm.x, half_mm.y, half_mm.y}}, half_mm.z, half_mm.z),
      {{joint, 0}},
      kRigid};
}

/// A metacarpal with the flesh between it and the next one, up to the knuckle.
Part metacarpal(const RestPose& rest, int finger) {
  const int joint = kMetacarpal[static_cast<std::size_t>(finger)];
  const glm::dvec3 base = rest.position_mm[joint], head = rest.position_mm[joint + 1];
  const double length = glm::distance(base, head), slim = finger == 4 ? 0.92 : 1;
  return {Limb(base, axes_along(head - base),
               {{0, 10.5 * slim, 9.5, 13},
                {0.5 * length, 11 * slim, 8.6, 12.5},
                {0.9 * length, 10.8 * slim, 8.8 * slim, 13 * slim},
                {1.02 * length, 10.4 * slim, 8.6 * slim, 12 * slim}},
               12, 11),
          {{joint, 0}},
          kRigid};
}

/// The web between a finger and the next one.
Part web(const HandShape& shape, const RestPose& rest, int finger) {
  const auto on_phalanx = [&](int f) {
    const auto i = static_cast<std::size_t>(f);
    const int knuckle = kMetacarpal[i] + 1;
    return rest.position_mm[knuckle] - rest.axes[knuckle][2] * (0.30 * shape.phalanx_mm[i][0]);
  };
  const glm::dvec3 one = on_phalanx(finger), other = on_phalanx(finger + 1);
  return ellipsoid((one + other) * 0.5 - glm::dvec3(0, 2.5, 0), other - one, {8, 6.5, 9},
                   kMetacarpal[static_cast<std::size_t>(finger)]);
}

/// Ball of the thumb, its web to the index finger, and the flesh on the little finger's side.
void add_balls(std::vector<Part>& parts, const RestPose& rest) {
  const auto between = [&](int joint, double share) {
    return glm::mix(rest.position_mm[joint], rest.position_mm[joint + 1], share);
  };
  const auto bone = [&](int joint) {
    return rest.position_mm[joint + 1] - rest.position_mm[joint];
  };
  const int thumb = kMetacarpal[0], index = kMetacarpal[1], little = kMetacarpal[4];
  parts.push_back(
      ellipsoid(between(thumb, 0.40) + glm::dvec3(-7, -3, -1), bone(thumb), {13, 13, 27}, thumb));
  const glm::dvec3 from = between(thumb, 0.66), to = between(index, 0.58) - glm::dvec3(0, 3, 0);
  parts.push_back(ellipsoid((from + to) * 0.5, to - from, {16, 7.5, 15}, thumb));
  parts.push_back(ellipsoid(between(little, 0.30) + glm::dvec3(-2, -7, 0), bone(little),
                            {11, 11.5, 30}, little));
}

}  // namespace

std::vector<Part> palm_parts(const HandShape& shape, const RestPose& rest) {
  std::vector<Part> parts;
  for (int f = 1; f < renderer::kFingers; ++f) parts.push_back(metacarpal(rest, f));
  for (int f = 1; f + 1 < renderer::kFingers; ++f) parts.push_back(web(shape, rest, f));
  add_balls(parts, rest);
  parts.push_back(ellipsoid({1, -6, -13}, {1, 0, 0}, {16, 11, 25}, kWrist));
  const glm::dvec2 half(shape.wrist_half_axes_mm);
  parts.push_back({Limb({0, 0, 0}, glm::dmat3(1),
                        {{-55, half.x * 1.04, half.y * 1.02, half.y * 1.02},
                         {-25, half.x * 0.98, half.y * 0.94, half.y * 0.95},
                         {0, half.x * 0.95, half.y * 0.82, half.y * 0.90},
                         {28, half.x * 0.95, half.y * 0.66, half.y * 0.80}},
                        4, 22),
                   {{kWrist, 0}},
                   kRigid});
  return parts;
}

}  // namespace handcast::twin
