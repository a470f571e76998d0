// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>
#include <ostream>
#include <string>

#include "renderer/mask/hand_mask.hpp"
#include "renderer/predict/projected_pose.hpp"
#include "services/lab/twin/surface.hpp"
#include "tests/renderer/mask/outline_score.hpp"
#include "tests/services/lab/twin/world.hpp"

/// The mask step on the twin's images against the true silhouette, with true poses as hints.
namespace handcast::renderer {
namespace {

constexpr float kTwinCut_px =
    3;  ///< the boundary nearer than this to the cut at the arm is no outline

/// The values that make the twin's images look like the real captures (docs/method.md#twin).
config::TwinImage like_captures() {
  config::TwinImage image;
  image.gain = 103;
  image.noise = 1;
  image.sleeve_mm = 90;
  image.spread_px = 2.1;
  image.subsurface_mm = 1.5;
  image.texture = 0.2;
  image.clutter = 0.04;
  image.sunlight = 0.04;
  image.table = 0.03;
  image.leak = 0.03;
  return image;
}

msg::HandPose pose_of(const JointFrames& joints) {
  msg::HandPose pose{};
  for (int j = 0; j < msg::kJoints; ++j) {
    const glm::vec3 p(joints[j][3]);
    const glm::quat q = glm::quat_cast(glm::mat3(joints[j]));
    pose.joints[j].position_m = {p.x, p.y, p.z};
    pose.joints[j].orientation_xyzw = {q.x, q.y, q.z, q.w};
  }
  return pose;
}

/// The true hand in the camera's image, without the forearm.
Image<std::uint8_t> silhouette_of(const twin::Twin& twin, const JointFrames& joints) {
  const auto rig = calib::reference_rig();
  const auto& flesh = twin.true_hand(Side::left);
  std::vector<glm::vec3> positions(flesh.mesh.vertex_count());
  twin::pose(flesh, joints, positions);
  twin::ScreenVertices screen;
  screen.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::dvec3 p(rig.camera_from_tracker * glm::dvec4(positions[v], 1));
    const glm::dvec2 px = rig.camera.distort(rig.camera.project(p));
    screen.x[v] = static_cast<float>(px.x);
    screen.y[v] = static_cast<float>(px.y);
    screen.inverse_depth[v] = static_cast<float>(1 / p.z);
  }
  Image<std::uint8_t> mask(720, 540, 0);
  Image<float> depth(720, 540);
  for (const auto& triangle : flesh.mesh.triangles)
    twin::draw_triangle(screen, triangle, -1, {0, 0, 720, 540}, depth.view(),
                        [&](int x, int y, float, float, float) { mask.at(x, y) = 255; });
  return mask;
}

/// The worst score of frames of two motions.
OutlineScore worst_score(const config::TwinImage& image) {
  OutlineScore worst{1, 0, 0};
  const auto rig = calib::reference_rig();
  for (const char* motion : {"builtin:open_close", "builtin:wave"}) {
    auto settings = twin::rig_with(motion);
    settings.twin.image = image;
    const auto twin = twin::twin_of(settings);
    HandMask step({}, rig);
    for (const std::uint64_t k : {20, 140, 260}) {
      Image<std::uint8_t> picture(720, 540);
      twin->camera_image(k, picture.view());
      const auto joints = *twin->joints(Side::left, twin->camera_origin_ns(k));
      const HandMask::Sought hand{
          .side = Side::left, .then = project(rig, pose_of(joints)), .has_landmarks = true};
      const TimedImage camera{picture.view(), 0};
      step.find(camera, std::span(&hand, 1));
      const auto hint = *make_hint(rig, {}, *hand.then, {}, true);
      const auto score = score_outline(
          step.silhouette(camera).mask, silhouette_of(*twin, joints).view(),
          [&](glm::vec2 at) { return glm::dot(at - hint.wrist_px, hint.to_elbow) < -kTwinCut_px; });
      worst.iou = std::min(worst.iou, score.iou);
      worst.p50_px = std::max(worst.p50_px, score.p50_px);
      worst.p95_px = std::max(worst.p95_px, score.p95_px);
    }
  }
  return worst;
}

struct Case {
  const char* name;
  void (*change)(config::TwinImage&);
  /// What it must keep: the goal, but for two scenes that miss it. Bright things of the background
  /// that touch the hand within the tracker's margin count as hand, and so does a thing in the
  /// hand.
  /// @{
  double iou, p95_px;
  /// @}
};
std::ostream& operator<<(std::ostream& out, const Case& scene) { return out << scene.name; }

class TwinMask : public testing::TestWithParam<Case> {};

TEST_P(TwinMask, KeepsTheOutline) {
  auto image = like_captures();
  GetParam().change(image);
  const auto score = worst_score(image);
  fmt::print(
      "{}: IoU {:.3f}, boundary p50 {:.2f} px, p95 {:.2f} px: {}\n", GetParam().name, score.iou,
      score.p50_px, score.p95_px,
      score.iou >= 0.95 && score.p95_px <= 2 ? "goal met" : "GOAL MISSED (IoU 0.95, p95 2 px)");
  EXPECT_GE(score.iou, GetParam().iou);
  EXPECT_LE(score.p95_px, GetParam().p95_px);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, TwinMask,
    testing::Values(Case{"as_before", [](config::TwinImage& i) { i = {}; }, 0.95, 2},
                    Case{"like_the_captures", [](config::TwinImage&) {}, 0.95, 2},
                    Case{"clutter", [](config::TwinImage& i) { i.clutter = 0.5; }, 0.95, 14},
                    Case{"sunlight", [](config::TwinImage& i) { i.sunlight = 0.5; }, 0.95, 2},
                    Case{"second_person", [](config::TwinImage& i) { i.second_person = true; },
                         0.95, 2},
                    Case{"leak", [](config::TwinImage& i) { i.leak = 0.5; }, 0.95, 2},
                    Case{"table", [](config::TwinImage& i) { i.table = 0.3; }, 0.95, 2},
                    Case{"texture", [](config::TwinImage& i) { i.texture = 0.5; }, 0.95, 2},
                    Case{"object", [](config::TwinImage& i) { i.object = true; }, 0.9, 18.5}),
    [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
}  // namespace handcast::renderer
