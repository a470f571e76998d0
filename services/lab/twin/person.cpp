// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/person.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/statistics.hpp"
#include "services/lab/twin/random.hpp"

namespace handcast::twin {
namespace {

using renderer::HandShape;

constexpr std::array<int, 5> kMetacarpal{2, 6, 11, 16, 21};
constexpr std::uint64_t kPalmDraw = 5, kWidthDraw = 6;

float width_factor(const config::TwinShape& settings, int seed) {
  return static_cast<float>(1 + settings.width_spread *
                                    Random(seed, Stream::person).spread(kWidthDraw));
}

glm::vec3 place_m(const msg::HandPose& pose, int joint) {
  const auto& p = pose.joints[joint].position_m;
  return {p[0], p[1], p[2]};
}

/// Position of a joint in the wrist's axes, in mm. A right hand is mirrored to a left one.
glm::vec3 from_wrist_mm(const msg::HandPose& pose, int joint) {
  const auto& q = pose.joints[1].orientation_xyzw;
  glm::vec3 place =
      glm::inverse(glm::quat(q[3], q[0], q[1], q[2])) * (place_m(pose, joint) - place_m(pose, 1));
  if (pose.side == msg::Side::right) place.x = -place.x;
  return place * 1e3f;
}

glm::vec3 median_place_mm(const std::vector<msg::HandPose>& poses, int joint) {
  std::array<std::vector<float>, 3> axes;
  for (const auto& pose : poses) {
    const glm::vec3 place = from_wrist_mm(pose, joint);
    for (int c = 0; c < 3; ++c) axes[c].push_back(place[c]);
  }
  return {median(axes[0]), median(axes[1]), median(axes[2])};
}

float median_length_mm(const std::vector<msg::HandPose>& poses, int joint) {
  std::vector<float> lengths;
  lengths.reserve(poses.size());
  for (const auto& pose : poses)
    lengths.push_back(1e3f * glm::distance(place_m(pose, joint), place_m(pose, joint + 1)));
  return median(lengths);
}

/// Distance between the MCPs of the index and the little finger.
float breadth_mm(const HandShape& shape) {
  return glm::distance(shape.proximal_mm[1], shape.proximal_mm[4]);
}

/// Mean distance of the fingers' MCPs from the wrist.
float palm_mm(const HandShape& shape) {
  float sum = 0;
  for (int f = 1; f < 5; ++f) sum += glm::length(shape.proximal_mm[f]);
  return sum / 4;
}

}  // namespace

HandShape draw_person(const config::TwinShape& settings, int seed) {
  const Random random(seed, Stream::person);
  std::array<float, 5> length;
  for (std::size_t f = 0; f < length.size(); ++f)
    length[f] = static_cast<float>(1 + settings.length_spread * random.spread(f));
  const auto palm = static_cast<float>(1 + settings.length_spread * random.spread(kPalmDraw));
  return HandShape::mean().scaled(length, palm, width_factor(settings, seed));
}

HandShape recorded_shape(const recording::RecordedHands& recording) {
  const auto& poses = recording.hands[0].empty() ? recording.hands[1] : recording.hands[0];
  HandShape shape = HandShape::mean();
  for (int f = 0; f < 5; ++f) {
    shape.metacarpal_mm[f] = median_place_mm(poses, kMetacarpal[f]);
    shape.proximal_mm[f] = median_place_mm(poses, kMetacarpal[f] + 1);
    for (int k = 0; k < (f == 0 ? 2 : 3); ++k)
      shape.phalanx_mm[f][k] = median_length_mm(poses, kMetacarpal[f] + 1 + k);
  }
  return shape;
}

HandShape person_of(const HandShape& recorded, const config::TwinShape& settings, int seed) {
  const HandShape mean = HandShape::mean();
  const float palm = palm_mm(recorded) / palm_mm(mean),
              width = breadth_mm(recorded) / breadth_mm(mean) * width_factor(settings, seed);
  HandShape person = mean.scaled({1, 1, 1, 1, 1}, palm, width);
  person.phalanx_mm = recorded.phalanx_mm;
  return person;
}

renderer::JointFrames bystander_joints(const renderer::HandMesh& hand,
                                       const calib::CameraModel& camera) {
  constexpr float kDistance_m = 0.85f;
  const glm::dvec2 wrist_px(0.97 * camera.width_px, 0.30 * camera.height_px);
  const glm::vec3 wrist((wrist_px.x - camera.cx_px) / camera.fx_px * kDistance_m,
                        (wrist_px.y - camera.cy_px) / camera.fy_px * kDistance_m, kDistance_m);
  // A hand's axes: x to the right, y out of the back, -z to the tips. The back faces the camera and
  // the fingers point to the left and a little down.
  const glm::vec3 fingers = glm::normalize(glm::vec3(-1, 0.25f, 0)), back(0, 0, -1);
  glm::mat4 camera_from_wrist(1);
  camera_from_wrist[0] = glm::vec4(glm::cross(back, -fingers), 0);
  camera_from_wrist[1] = glm::vec4(back, 0);
  camera_from_wrist[2] = glm::vec4(-fingers, 0);
  camera_from_wrist[3] = glm::vec4(wrist, 1);
  const glm::mat4 camera_from_model = camera_from_wrist * glm::inverse(hand.rest[1]);
  renderer::JointFrames joints;
  for (int j = 0; j < msg::kJoints; ++j) joints[j] = camera_from_model * hand.rest[j];
  return joints;
}

}  // namespace handcast::twin
