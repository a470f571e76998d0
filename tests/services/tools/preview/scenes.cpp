// SPDX-License-Identifier: Apache-2.0
#include "tests/services/tools/preview/scenes.hpp"

#include <algorithm>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/quaternion.hpp>

namespace handcast::preview::test {

World world() {
  World world{.calibration = calib::reference_rig(), .mask = {}, .predict = {}, .hands = {}};
  for (auto& mesh : world.hands) {
    mesh.positions.resize(4);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  }
  return world;
}

msg::Owned<msg::CameraFrame> frame(std::int64_t origin_ns, std::uint8_t grey) {
  const auto camera = world().calibration.camera;
  const auto width = static_cast<std::uint32_t>(camera.width_px),
             height = static_cast<std::uint32_t>(camera.height_px);
  msg::Owned<msg::CameraFrame> frame(msg::CameraFrame::bytes(width, height));
  frame->header = {.frame_id = 7, .origin_ns = origin_ns, .published_ns = origin_ns + 2 * kMs};
  frame->width_px = width;
  frame->height_px = height;
  std::fill_n(frame->pixels(), std::size_t{width} * height, grey);
  return frame;
}

msg::Owned<msg::Projection> light(std::int64_t target_ns) {
  constexpr std::uint32_t kSide_px = 64;
  msg::Owned<msg::Projection> light(msg::Projection::bytes(kSide_px, kSide_px));
  light->header.frame_id = 9;
  light->target_ns = light->lit_ns = target_ns;
  light->made_from.image_ns = kImage_ns;
  light->width_px = 1024;
  light->height_px = 768;
  light->region_x_px = light->region_y_px = 100;
  light->region_width_px = light->region_height_px = kSide_px;
  std::fill_n(light->pixels(), kSide_px * kSide_px, 0xff00ff00u);
  return light;
}

void draw_square(msg::Projection& projection, glm::vec2 low, glm::vec2 high) {
  projection.hand_count = 1;
  auto& hand = projection.hands[0];
  hand.side = msg::Side::left;
  hand.vertex_count = 4;
  // Turned so that it faces the camera.
  hand.landings[0] = {low.x, low.y};
  hand.landings[1] = {low.x, high.y};
  hand.landings[2] = {high.x, high.y};
  hand.landings[3] = {high.x, low.y};
}

msg::HandPoses poses(std::int64_t origin_ns, glm::dvec2 image_px) {
  const auto calibration = world().calibration;
  const auto tracker_from_camera = glm::inverse(calibration.camera_from_tracker);
  msg::HandPoses poses;
  poses.header = {.frame_id = 1, .origin_ns = origin_ns, .published_ns = origin_ns + 9 * kMs};
  poses.count = 1;
  poses.hands[0].side = msg::Side::left;
  poses.hands[0].confidence = 1;
  for (int i = 0; i < msg::kJoints; ++i) {
    const glm::dvec2 px =
        calibration.camera.undistort(image_px + 20.0 * glm::dvec2(i % 5 - 2, i / 5 - 2));
    const auto& camera = calibration.camera;
    const glm::dvec4 point((px.x - camera.cx_px) / camera.fx_px * kDistance_m,
                           (px.y - camera.cy_px) / camera.fy_px * kDistance_m, kDistance_m, 1);
    const glm::dvec4 at = tracker_from_camera * point;
    poses.hands[0].joints[static_cast<std::size_t>(i)] = {
        .position_m = {static_cast<float>(at.x), static_cast<float>(at.y),
                       static_cast<float>(at.z)},
        .radius_m = 0.01f};
  }
  // The wrist is the uppermost joint: its forearm points up in the image.
  const auto up = glm::inverse(glm::dmat3(calibration.camera_from_tracker)) * glm::dvec3(0, -1, 0);
  const glm::quat turn(glm::vec3(0, 0, 1), glm::vec3(glm::normalize(up)));
  poses.hands[0].joints[1].orientation_xyzw = {turn.x, turn.y, turn.z, turn.w};
  return poses;
}

msg::Landmarks landmarks(std::int64_t origin_ns, glm::vec2 px, float sigma_px) {
  msg::Landmarks landmarks;
  landmarks.header = {.frame_id = 7, .origin_ns = origin_ns, .published_ns = origin_ns + 16 * kMs};
  landmarks.count = 1;
  landmarks.hands[0].side = msg::Side::left;
  landmarks.hands[0].presence = 1;
  landmarks.hands[0].points.fill(
      {.x_px = px.x, .y_px = px.y, .confidence = 1, .sigma_px = sigma_px});
  return landmarks;
}

}  // namespace handcast::preview::test
