// SPDX-License-Identifier: Apache-2.0
#include "services/pose/lift/starts.hpp"

namespace handcast::pose {
namespace {

constexpr double kTilt_rad = 0.45;
constexpr double kBentAtRest_rad = 0.3;
constexpr int kIndexKnuckle = 5, kMiddleKnuckle = 9, kLittleKnuckle = 17;  ///< landmarks

/// Camera from hand: the hand's -z axis along `along` in the image, its back towards the camera or
/// away from it.
glm::dmat3 facing(glm::dvec2 along, bool shows_back) {
  const glm::dvec3 z(-along, 0), y(0, 0, shows_back ? -1 : 1);
  return {glm::cross(y, z), y, z};
}

}  // namespace

std::array<Posture, 4> starts_for(const Skeleton& skeleton, const calib::CameraModel& camera,
                                  double distance_m, const SeenHand& seen, double log_size) {
  const glm::dvec2 palm_px = 0.5 * (seen.px[0] + seen.px[kMiddleKnuckle]);
  glm::dvec2 along = seen.px[kMiddleKnuckle] - seen.px[0];
  along = glm::length(along) > 1e-3 ? glm::normalize(along) : glm::dvec2(0, -1);
  const double index_to_right =
      glm::dot(seen.px[kIndexKnuckle] - seen.px[kLittleKnuckle], glm::dvec2(-along.y, along.x));
  const int index = msg::kJointOfLandmark[kIndexKnuckle],
            little = msg::kJointOfLandmark[kLittleKnuckle];
  const bool index_at_plus_x = skeleton.at_rest_m(index).x > skeleton.at_rest_m(little).x;
  // With the back to the camera, the hand's x axis points to the right of `along`.
  const glm::dmat3 turn = facing(along, (index_to_right > 0) == index_at_plus_x);

  Posture start;
  start.palm_m = (palm_px - glm::dvec2(camera.cx_px, camera.cy_px)) /
                 glm::dvec2(camera.fx_px, camera.fy_px) * distance_m;
  start.log_size = log_size;
  start = with_fingers_at_rest(start);
  std::array<Posture, 4> starts;
  for (int i = 0; i < 4; ++i) {
    const glm::dquat nod = glm::angleAxis(i & 1 ? kTilt_rad : -kTilt_rad, glm::dvec3(1, 0, 0));
    const glm::dquat roll = glm::angleAxis(i & 2 ? kTilt_rad : -kTilt_rad, glm::dvec3(0, 0, 1));
    starts[i] = start;
    starts[i].turn = glm::normalize(glm::quat_cast(turn) * nod * roll);
  }
  return starts;
}

Posture mirrored_in_depth(const Posture& posture) {
  const glm::dmat3 turn = glm::mat3_cast(posture.turn);
  const glm::dmat3 depth(1, 0, 0, 0, 1, 0, 0, 0, -1), back(1, 0, 0, 0, -1, 0, 0, 0, 1);
  Posture other = with_fingers_at_rest(posture);
  other.turn = glm::normalize(glm::quat_cast(depth * turn * back));
  return other;
}

Posture with_fingers_at_rest(Posture posture) {
  posture.angle = {};
  for (int f = 1; f < kFingers; ++f) posture.angle[f] = {0, kBentAtRest_rad, kBentAtRest_rad, 0.2};
  return posture;
}

}  // namespace handcast::pose
