// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "calib/calibration.hpp"
#include "renderer/hand/hand_mesh.hpp"
#include "renderer/pipeline/pipeline.hpp"
#include "renderer/skin/skinning.hpp"
#include "services/lab/hand_maker/hand_shape.hpp"
#include "tests/milliseconds.hpp"
#include "tests/renderer/hand_pose.hpp"

/// @file
/// A scene for tests of the pipeline: poses, landmarks and images of the default hands.

namespace handcast::renderer {

/// The paper's rig, with tracker space equal to model space: the camera sees the back of the hand
/// from 0.55 m, fingers up.
inline calib::Calibration rig_above_hand() {
  calib::Calibration calibration = calib::reference_rig();
  calibration.camera_from_tracker =
      glm::dmat4({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0.09, 0.55, 1});
  return calibration;
}

/// The default hand of a side.
inline const HandMesh& default_hand(Side side) {
  static const std::array<HandMesh, 2> hands{*load_hand_or_default({}, Side::left),
                                             *load_hand_or_default({}, Side::right)};
  return hands[static_cast<std::size_t>(side)];
}

inline msg::HandPose pose_of(Side side, glm::vec3 moved_m = {}) {
  return pose_of(side, default_hand(side).rest, moved_m);
}

inline msg::HandPoses poses_of(std::int64_t origin_ns, const std::vector<msg::HandPose>& hands) {
  msg::HandPoses poses;
  poses.header.origin_ns = origin_ns;
  for (const auto& hand : hands) poses.hands[poses.count++] = hand;
  return poses;
}

inline glm::dvec3 in_camera(const calib::Calibration& calibration, glm::vec3 tracker_m) {
  return glm::dvec3(calibration.camera_from_tracker * glm::dvec4(tracker_m, 1));
}

/// The landmarks of a perfect detector for `pose`, moved by `offset_px`.
inline msg::Landmarks landmarks_of(const calib::Calibration& calibration, std::int64_t origin_ns,
                                   const msg::HandPose& pose, glm::vec2 offset_px) {
  msg::Landmarks landmarks;
  landmarks.header.origin_ns = origin_ns;
  landmarks.count = 1;
  landmarks.hands[0].side = pose.side;
  for (int i = 0; i < kLandmarks; ++i) {
    const auto& [x, y, z] = pose.joints[msg::kJointOfLandmark[i]].position_m;
    const glm::dvec2 px = calibration.camera.project(in_camera(calibration, {x, y, z}));
    landmarks.hands[0].points[i] = {static_cast<float>(px.x) + offset_px.x,
                                    static_cast<float>(px.y) + offset_px.y, 1};
  }
  return landmarks;
}

/// The camera's image of hands in `poses`, each moved by `offset_px`: grey value 150 on 8.
inline Image<std::uint8_t> image_of(const calib::Calibration& calibration,
                                    std::initializer_list<msg::HandPose> poses,
                                    glm::dvec2 offset_px = {}) {
  Image<std::uint8_t> image(calibration.camera.width_px, calibration.camera.height_px, 8);
  for (const auto& pose : poses) {
    const HandMesh& hand = default_hand(pose.side);
    std::vector<glm::vec3> skin_m(hand.vertex_count());
    skin(hand, frames_of(pose), skin_m);
    std::vector<glm::dvec2> px;
    px.reserve(skin_m.size());
    for (const auto& point : skin_m)
      px.push_back(calibration.camera.distort(
          calibration.camera.project(in_camera(calibration, point)) + offset_px));
    for (const auto& triangle : hand.triangles) {
      const glm::dvec2 a = px[triangle[0]], b = px[triangle[1]], c = px[triangle[2]];
      const auto side = [](glm::dvec2 u, glm::dvec2 v, glm::dvec2 w) {
        return (v.x - u.x) * (w.y - u.y) - (w.x - u.x) * (v.y - u.y);
      };
      const glm::dvec2 low = glm::max(glm::min(a, glm::min(b, c)), glm::dvec2(0));
      const glm::dvec2 high =
          glm::min(glm::max(a, glm::max(b, c)), glm::dvec2(image.width() - 1, image.height() - 1));
      for (int y = static_cast<int>(low.y); y <= high.y; ++y)
        for (int x = static_cast<int>(low.x); x <= high.x; ++x) {
          const double s = side(a, b, {x, y}), t = side(b, c, {x, y}), u = side(c, a, {x, y});
          if ((s >= 0 && t >= 0 && u >= 0) || (s <= 0 && t <= 0 && u <= 0)) image.at(x, y) = 150;
        }
    }
  }
  return image;
}

}  // namespace handcast::renderer
