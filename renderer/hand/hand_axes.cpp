// SPDX-License-Identifier: Apache-2.0
#include "renderer/hand/hand_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string_view>
#include <vector>

namespace handcast::renderer {
namespace {

constexpr int kWrist = 1, kThumb = 2, kIndex = 7, kMiddle = 12, kLittle = 22;  // the knuckles

using Axes = std::array<glm::mat3, kJoints>;

bool is_thumb(int joint) { return joint >= kThumb && joint < kThumb + 4; }
bool is_tip(int joint) { return kJointNames[joint].ends_with("-tip"); }
bool is_phalanx(int joint) {
  return kJointNames[joint].find("phalanx") != std::string_view::npos || joint == kThumb;
}
glm::vec3 place_of(const JointFrames& rest, int joint) { return glm::vec3(rest[joint][3]); }

/// The normal of the plane of wrist and knuckles that points out of the palm of a left hand and out
/// of the back of a right one.
glm::vec3 normal_of(const JointFrames& rest) {
  return glm::normalize(glm::cross(place_of(rest, kMiddle) - place_of(rest, kWrist),
                                   place_of(rest, kIndex) - place_of(rest, kLittle)));
}

/// Axes with -z along `bone` and +y as near to `up` as possible.
glm::mat3 axes_along(const glm::vec3& bone, const glm::vec3& up) {
  const auto z = -glm::normalize(bone);
  auto across = glm::cross(up, z);
  if (glm::length(across) < 1e-3f)  // any will do
    across = glm::cross(std::abs(z.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0), z);
  const auto x = glm::normalize(across);
  return {x, glm::cross(z, x), z};
}

/// The axes of OpenXR by the places of the joints: +y of the fingers out of the back of the hand,
/// that of the thumb as in handcast's own hand.
Axes axes_of_places(const JointFrames& rest, Side side) {
  const auto normal = normal_of(rest);
  const auto back = side == Side::left ? -normal : normal;
  Axes axes;
  axes[kWrist] = axes_along(place_of(rest, kMiddle) - place_of(rest, kWrist), back);
  axes[0] = axes[kWrist];
  const auto thumb_back =
      axes[kWrist] * glm::vec3(side == Side::left ? 0.54f : -0.54f, 0.84f, 0.06f);
  for (int joint = kThumb; joint < kJoints; ++joint) {
    constexpr float kShortest_m = 1e-3f;
    const int next = is_tip(joint) ? joint : joint + 1;
    const auto bone = place_of(rest, next) - place_of(rest, joint);
    axes[joint] = glm::length(bone) < kShortest_m
                      ? axes[kJointParent[joint]]  // the direction of the bone before
                      : axes_along(bone, is_thumb(joint) ? thumb_back : back);
  }
  return axes;
}

/// The angle between two orientations, degrees.
float angle_deg(const glm::mat3& a, const glm::mat3& b) {
  const auto between = glm::transpose(a) * b;
  const float cosine = (between[0][0] + between[1][1] + between[2][2] - 1) / 2;
  return glm::degrees(std::acos(std::clamp(cosine, -1.f, 1.f)));
}

/// All turns that map axes onto axes; the first one is none.
std::vector<glm::mat3> quarter_turns() {
  std::vector<glm::mat3> turns;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (const float x_sign : {1.f, -1.f})
        for (const float y_sign : {1.f, -1.f}) {
          if (x == y) continue;
          glm::mat3 turn(0);
          turn[0][x] = x_sign;
          turn[1][y] = y_sign;
          turn[2] = glm::cross(turn[0], turn[1]);
          turns.push_back(turn);
        }
  return turns;
}

/// How far the axes of the phalanges are from those by their places, mean angles in degrees.
struct Difference {
  float axes_deg = 0;   ///< of all axes
  float bones_deg = 0;  ///< of the directions of the bones

  bool is_none() const { return bones_deg < 8 && axes_deg < 40; }
};

Difference difference(const JointFrames& rest, const glm::mat3& turn, const Axes& by_places) {
  Difference mean;
  float count = 0;
  for (int joint = 0; joint < kJoints; ++joint) {
    if (!is_phalanx(joint)) continue;
    const auto axes = glm::mat3(rest[joint]) * turn;
    const float cosine = std::clamp(glm::dot(axes[2], by_places[joint][2]), -1.f, 1.f);
    mean.axes_deg += angle_deg(axes, by_places[joint]);
    mean.bones_deg += glm::degrees(std::acos(cosine));
    ++count;
  }
  return {mean.axes_deg / count, mean.bones_deg / count};
}

void set_axes(glm::mat4& frame, const glm::mat3& axes) {
  for (int k = 0; k < 3; ++k) frame[k] = glm::vec4(axes[k], 0);
}

/// The distance to the bone that begins at a joint.
float to_bone_m(const glm::vec3& point, const JointFrames& frames, int joint) {
  const auto from = place_of(frames, joint);
  const auto along = place_of(frames, is_tip(joint) ? joint : joint + 1) - from;
  const float length2 = std::max(glm::dot(along, along), 1e-12f);
  const float part = std::clamp(glm::dot(point - from, along) / length2, 0.f, 1.f);
  return glm::distance(point, from + part * along);
}

/// The joint with the largest weight.
int leader_of(const HandMesh& hand, std::size_t vertex) {
  const auto& weights = hand.weights[vertex];
  return hand.joints[vertex]
                    [static_cast<std::size_t>(std::ranges::max_element(weights) - weights.begin())];
}

/// The frames of a half closed hand, by the axes that a tracker gives its joints.
JointFrames bent(const JointFrames& rest, const Axes& axes) {
  constexpr float kBend_rad = 0.6f;
  JointFrames frames = rest;
  for (int joint = 0; joint < kJoints; ++joint) set_axes(frames[joint], axes[joint]);
  const auto straight = frames;
  for (int joint = kThumb; joint < kJoints; ++joint) {
    const auto parent = static_cast<std::size_t>(kJointParent[joint]);
    frames[joint] = frames[parent] * glm::inverse(straight[parent]) * straight[joint];
    if (is_phalanx(joint) && !is_thumb(joint))
      frames[joint] = glm::rotate(frames[joint], -kBend_rad, {1, 0, 0});
  }
  return frames;
}

std::vector<glm::vec3> skinned(const HandMesh& hand, const JointFrames& frames) {
  std::array<glm::mat4, kJoints> moves;
  for (int joint = 0; joint < kJoints; ++joint)
    moves[joint] = frames[joint] * glm::inverse(hand.rest[joint]);
  std::vector<glm::vec3> positions;
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    glm::vec4 sum(0);
    for (int k = 0; k < 4; ++k)
      sum += hand.weights[v][k] * (moves[hand.joints[v][k]] * glm::vec4(hand.positions[v], 1));
    positions.emplace_back(sum);
  }
  return positions;
}

}  // namespace

bool has_palm(const JointFrames& rest) { return std::isfinite(normal_of(rest).x); }

std::optional<Side> side_of_joints(const JointFrames& rest) {
  constexpr float kFlat_m = 0.005f;
  const auto normal = normal_of(rest);
  float height_m = 0;  // of the thumb and of the fingers' ends over the plane
  for (int joint = kThumb; joint < kThumb + 4; ++joint)
    height_m += glm::dot(place_of(rest, joint) - place_of(rest, kWrist), normal) / 4;
  for (int knuckle = kIndex; knuckle < kJoints; knuckle += 5)
    height_m += glm::dot(place_of(rest, knuckle + 2) - place_of(rest, knuckle), normal) / 4;
  if (!(std::abs(height_m) > kFlat_m)) return std::nullopt;
  return height_m > 0 ? Side::left : Side::right;
}

std::string settle_axes(HandMesh& hand, const FoundJoints& found) {
  constexpr float kOdd_deg = 75;  // the thumb of WebXR's hands is rolled by 54
  const auto by_places = axes_of_places(hand.rest, hand.side);
  const auto turns = quarter_turns();
  const auto off_deg = [&](const glm::mat3& turn) {
    return difference(hand.rest, turn, by_places).axes_deg;
  };
  const auto turn = difference(hand.rest, turns.front(), by_places).is_none()
                        ? turns.begin()
                        : std::ranges::min_element(turns, {}, off_deg);
  const bool fits = difference(hand.rest, *turn, by_places).is_none(),
             is_turned = turn != turns.begin();
  bool is_odd = false;
  for (int joint = 0; joint < kJoints; ++joint) {
    if (!found[joint]) continue;
    const auto turned = glm::mat3(hand.rest[joint]) * *turn;
    const bool keeps = fits && angle_deg(turned, by_places[joint]) < kOdd_deg;
    is_odd = is_odd || !keeps;
    if (!keeps || is_turned) set_axes(hand.rest[joint], keeps ? turned : by_places[joint]);
  }
  if (fits && is_turned) return "the axes of its joints are turned so that -z lies along the bones";
  return is_odd ? "axes of its joints are taken from the places of the joints" : "";
}

std::string fault_when_bent(const HandMesh& hand) {
  std::array<int, kJoints> led{}, astray{};
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) ++led[leader_of(hand, v)];
  std::string bare;
  for (int joint = 0; joint < kJoints; ++joint)
    if (is_phalanx(joint) && led[joint] + (is_phalanx(joint + 1) ? 0 : led[joint + 1]) == 0)
      bare += fmt::format("{}{}", bare.empty() ? "" : ", ", kJointNames[joint]);
  if (!bare.empty()) return fmt::format("no part of its mesh moves with the joints {}", bare);

  constexpr float kThickest_m = 0.05f, kMoved_m = 0.012f;
  const auto frames = bent(hand.rest, axes_of_places(hand.rest, hand.side));
  const auto positions = skinned(hand, frames);
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    const int joint = leader_of(hand, v);
    if (!is_phalanx(joint) && !is_tip(joint)) continue;
    const float before_m = to_bone_m(hand.positions[v], hand.rest, joint),
                after_m = to_bone_m(positions[v], frames, joint);
    astray[joint] += before_m > kThickest_m || std::abs(after_m - before_m) > kMoved_m;
  }
  for (int joint = 0; joint < kJoints; ++joint)
    if (4 * astray[joint] > led[joint])
      return fmt::format(
          "bent as a half closed hand, {} of the {} vertices that move with its joint {} leave "
          "their finger; look at its weights and at the axes of its joints",
          astray[joint], led[joint], kJointNames[joint]);
  return {};
}

}  // namespace handcast::renderer
