// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "services/lab/training/scene.hpp"
#include "services/landmarks/models/handcast_network.hpp"

namespace handcast::landmarks::training {
namespace {

using renderer::JointFrames;

constexpr float kPi = std::numbers::pi_v<float>;

glm::vec3 draw_direction(Dice& dice) {
  return glm::normalize(glm::vec3(dice.normal(1), dice.normal(1), dice.normal(1)) + 1e-6f);
}

glm::mat4 turn(float angle_rad, const glm::vec3& axis) {
  return glm::rotate(glm::mat4(1), angle_rad, axis);
}

/// From hand axes (y out of the back, -z to the tips) to camera axes: fingers up, back to the
/// camera.
glm::mat4 upright() { return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}; }

glm::vec3 middle_of(const JointFrames& joints) {
  glm::vec3 sum(0);
  for (const int joint : msg::kJointOfLandmark) sum += glm::vec3(joints[joint][3]);
  return sum / static_cast<float>(msg::kLandmarks);
}

/// Errors of every angle; in some postures, a few fingers are grossly wrong.
Posture disturbed(Dice& dice, Posture posture) {
  auto& bend = posture.bend;
  const bool gross = dice.chance(0.14f);
  const float spread = gross ? 0.4f : dice.between(0.04f, 0.25f);
  for (int finger = 0; finger < 5; ++finger) {
    const float wrong = gross && dice.chance(0.4f) ? dice.between(-1.2f, 1.2f) : 0;
    for (int k = 0; k < 3; ++k)
      bend.flexion[finger][k] += dice.normal(spread) + wrong * (k == 1 ? 1.0f : 0.6f);
    bend.splay[finger] += dice.normal(0.06f);
    posture.roll[finger] += dice.normal(0.1f);
  }
  bend.thumb_flexion += dice.normal(spread);
  bend.thumb_opposition += dice.normal(spread);
  return posture;
}

/// Misplaces the whole hand in the image: a shift, and a slight affine distortion about the wrist.
void misplace(Dice& dice, Points& points_px, float palm_px) {
  const float kind = dice.uniform();
  const float shift_px = palm_px * (kind < 0.5f ? 0.14f : kind < 0.8f ? 0.28f : 0.02f);
  const float skew = kind < 0.8f ? 0.03f : 0.01f;
  const glm::vec2 by(dice.normal(shift_px), dice.normal(shift_px));
  const glm::mat2 skewed(1 + dice.normal(skew), dice.normal(skew), dice.normal(skew),
                         1 + dice.normal(skew));
  const glm::vec2 wrist = points_px[0];
  for (auto& point : points_px)
    point = wrist + skewed * (point - wrist) + by +
            glm::vec2(dice.normal(0.01f * palm_px), dice.normal(0.01f * palm_px));
}

}  // namespace

JointFrames moved(const glm::mat4& m, const JointFrames& joints) {
  JointFrames result;
  for (std::size_t j = 0; j < joints.size(); ++j) result[j] = m * joints[j];
  return result;
}

/// Back or palm face the camera, or the hand's edge does, where most is hidden.
glm::mat4 draw_view(Dice& dice, const JointFrames& joints) {
  const float kind = dice.uniform();
  float spin = dice.between(-kPi, kPi);
  const float side = dice.chance(0.5f) ? 1.f : -1.f;
  if (kind < 0.3f)
    spin = (side > 0 ? kPi : 0) + dice.normal(0.45f);
  else if (kind < 0.7f)
    spin = side * 0.5f * kPi + dice.normal(0.35f);
  glm::mat4 turned = turn(spin, {0, 1, 0}) * upright();
  if (kind > 0.94f)
    turned = turn(dice.between(-kPi, kPi), draw_direction(dice)) * turned;
  else
    turned =
        turn(dice.normal(0.45f), glm::normalize(glm::vec3(dice.normal(1), dice.normal(1), 1e-3f))) *
        turned;
  turned = turn(dice.between(-0.9f, 0.9f), {0, 0, 1}) * turned;
  const glm::vec3 place(dice.between(-0.12f, 0.12f), dice.between(-0.08f, 0.08f),
                        dice.between(0.48f, 0.8f));
  return glm::translate(glm::mat4(1), place - glm::vec3(turned * glm::vec4(middle_of(joints), 1))) *
         turned;
}

Points project(const calib::CameraModel& camera, const JointFrames& in_camera) {
  Points points_px;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    glm::dvec3 place(in_camera[msg::kJointOfLandmark[i]][3]);
    place.z = std::max(place.z, 0.05);
    points_px[i] = camera.project(place);
  }
  return points_px;
}

Points draw_tracker(Dice& dice, const calib::CameraModel& camera, const std::vector<Person>& people,
                    const Person& person, const Pose& pose, const JointFrames& in_camera,
                    const Definitions& definitions) {
  const Person& model =
      dice.chance(0.75f)
          ? person
          : people[dice.pick(static_cast<int>(people.size()))];  // the person that it assumes
  const bool other_pose = dice.chance(0.2f);
  const Posture posture =
      other_pose ? draw_pose(dice, model).posture : disturbed(dice, pose.posture);
  const float turned_rad = other_pose && dice.chance(0.5f) ? dice.normal(0.5f) : dice.normal(0.12f);
  const glm::mat4 wrong = turn(turned_rad, draw_direction(dice)) *
                          glm::scale(glm::mat4(1), glm::vec3(std::exp(dice.normal(0.05f))));
  glm::mat4 camera_from_wrist = in_camera[kWristJoint];
  const glm::vec4 wrist = camera_from_wrist[3];
  camera_from_wrist[3] = {0, 0, 0, 1};
  camera_from_wrist = wrong * camera_from_wrist;
  camera_from_wrist[3] = wrist;
  Points points_px = project(
      camera, defined(moved(camera_from_wrist, pose_of(model, posture).joints), definitions));
  misplace(dice, points_px, std::max(60.0f, palm_length_px(project(camera, in_camera))));
  if (dice.chance(0.02f))
    for (int k = 5; k < 9; ++k)
      std::swap(points_px[k], points_px[k + 4]);  // index and middle finger exchanged
  return points_px;
}

Region draw_region(Dice& dice, const Points& truth_px, const Points* tracker_px) {
  const bool from_tracker = tracker_px && dice.chance(0.4f);
  const float size = from_tracker ? 0.3f : dice.chance(0.5f) ? 1.0f : 0.4f;
  Region region = handcast_network::region_around(from_tracker ? *tracker_px : truth_px);
  region.angle_rad += dice.normal(0.25f * size);
  region.centre_px +=
      region.size_px * glm::vec2(dice.normal(0.06f * size), dice.normal(0.06f * size));
  region.size_px *= std::exp(dice.normal(0.1f * size));
  return region;
}

Region draw_arm_region(Dice& dice, const Points& hand_px) {
  Region region = handcast_network::region_around(hand_px);
  const glm::vec2 along = glm::normalize(hand_px[0] - hand_px[9]);
  region.centre_px += dice.normal(0.15f) * region.size_px * glm::vec2(-along.y, along.x);
  region.angle_rad += dice.normal(0.8f);
  region.size_px *= std::exp(dice.normal(0.25f));
  const auto shows_fingers = [&] {
    const auto places = handcast_network::to_places(region, msg::Side::right, hand_px);
    return std::ranges::any_of(places.begin() + 1, places.end(), [](glm::vec2 place) {
      return place.x > 0 && place.x < 1 && place.y > 0 && place.y < 1;
    });
  };
  do region.centre_px += 0.1f * region.size_px * along;
  while (shows_fingers());
  return region;
}

}  // namespace handcast::landmarks::training
