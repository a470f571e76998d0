// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/true_view.hpp"

#include <algorithm>

#include "services/lab/twin/finger_pose.hpp"

namespace handcast::twin {
namespace {

using renderer::Rect;

constexpr float kArmBegins_m = 0.005f;  ///< behind the wrist
/// Velocities are central differences over this time before and after.
constexpr std::int64_t kVelocityStep_ns = 1'000'000;

}  // namespace

TrueView::TrueView(const Twin& twin, const calib::Calibration& seen)
    : twin_(twin),
      projection_(seen.projection()),
      surface_(seen.projector.width_px, seen.projector.height_px),
      inverse_depth_(seen.projector.width_px, seen.projector.height_px) {
  // A projection that mirrors reverses the orientation of the triangles.
  front_ = glm::determinant(glm::dmat3(projection_)) > 0 ? -1.0f : 1.0f;
  for (const Side side : {Side::left, Side::right}) {
    const auto s = static_cast<std::size_t>(side);
    behind_wrist_m_[s] = behind_wrist_m(twin.true_hand(side).mesh);
    forearms_[s] = make_forearm(twin.true_hand(side).mesh, kBareArm_m);
  }
}

std::optional<JointFrames> TrueView::joints_in_camera(Side side, std::int64_t time_ns) const {
  auto joints = twin_.joints(side, time_ns);
  const glm::mat4 camera_from_tracker(twin_.geometry().calibration().camera_from_tracker);
  if (joints)
    for (auto& frame : *joints) frame = camera_from_tracker * frame;
  return joints;
}

void TrueView::pose(std::int64_t time_ns) {
  count_ = 0;
  for (const Side side : {Side::left, Side::right}) {
    const auto joints = joints_in_camera(side, time_ns);
    if (joints) pose_hand(seen_[count_++], side, time_ns, *joints);
  }
}

void TrueView::project(std::span<const glm::vec3> positions, ScreenVertices& screen) const {
  screen.resize(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const glm::dvec3 seen = at(positions[v]);
    screen.x[v] = static_cast<float>(seen.x / seen.z);
    screen.y[v] = static_cast<float>(seen.y / seen.z);
    screen.inverse_depth[v] = static_cast<float>(1 / seen.z);
  }
}

void TrueView::pose_hand(SeenHand& hand, Side side, std::int64_t time_ns,
                         const JointFrames& joints) {
  hand.side = side;
  hand.truth = &twin_.true_hand(side);
  hand.position_m.resize(hand.truth->mesh.vertex_count());
  twin::pose(*hand.truth, joints, hand.position_m);
  project(hand.position_m, hand.screen);
  find_velocities(hand, time_ns, joints);
  for (int j = 0; j < msg::kJoints; ++j) hand.joints_px[j] = to_projector(glm::vec3(joints[j][3]));
  pose_arm(hand, joints);
}

/// A hand that appears or disappears within the step is taken to rest in the missing half.
void TrueView::find_velocities(SeenHand& hand, std::int64_t time_ns, const JointFrames& joints) {
  constexpr float kPerSecond = 1e9f / (2 * kVelocityStep_ns);
  const std::size_t count = hand.position_m.size();
  before_.resize(count);
  after_.resize(count);
  twin::pose(*hand.truth, joints_in_camera(hand.side, time_ns - kVelocityStep_ns).value_or(joints),
             before_);
  twin::pose(*hand.truth, joints_in_camera(hand.side, time_ns + kVelocityStep_ns).value_or(joints),
             after_);
  hand.velocity_m_s.resize(count);
  hand.velocity_px_s.resize(count);
  for (std::size_t v = 0; v < count; ++v) {
    hand.velocity_m_s[v] = (after_[v] - before_[v]) * kPerSecond;
    hand.velocity_px_s[v] = (to_projector(after_[v]) - to_projector(before_[v])) * kPerSecond;
  }
}

void TrueView::pose_arm(SeenHand& hand, const JointFrames& joints) {
  after_.clear();
  for (const glm::vec3& position : forearms_[static_cast<std::size_t>(hand.side)].positions)
    after_.push_back(glm::vec3(joints[kWristJoint] * glm::vec4(position, 1)));
  project(after_, hand.arm);
}

std::optional<glm::ivec2> TrueView::lit_by(const glm::vec3& camera_m) const {
  constexpr double kBehind_m = 0.002;  // a pixel's breadth on a steep surface
  const glm::dvec3 seen = at(camera_m);
  const glm::ivec2 px(glm::round(glm::dvec2(seen) / seen.z));
  if (px.x < drawn_.x0 || px.y < drawn_.y0 || px.x >= drawn_.x1 || px.y >= drawn_.y1) return {};
  if (!is_hand(surface_.at(px.x, px.y)) || 1 / inverse_depth_.at(px.x, px.y) < seen.z - kBehind_m)
    return {};
  return px;
}

void TrueView::draw(const Rect& area) {
  drawn_ = area;
  for (int y = area.y0; y < area.y1; ++y) {
    std::fill_n(surface_.row(y) + area.x0, area.width(), kNothing);
    std::fill_n(inverse_depth_.row(y) + area.x0, area.width(), 0.0f);
  }
  for (std::size_t h = 0; h < count_; ++h) draw_hand(h, area);
}

/// Draws a hand and its arm with a depth test.
void TrueView::draw_hand(std::size_t index, const Rect& area) {
  const SeenHand& hand = seen_[index];
  const auto& behind = behind_wrist_m_[static_cast<std::size_t>(hand.side)];
  const auto& triangles = hand.truth->mesh.triangles;
  const auto out = surface_.view();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [i, j, k] = triangles[t];
    const float za = behind[i], zb = behind[j], zc = behind[k];
    draw_triangle(hand.screen, triangles[t], front_, area, inverse_depth_.view(),
                  [&](int x, int y, float a, float b, float c) {
                    out.at(x, y) =
                        a * za + b * zb + c * zc > kArmBegins_m ? kArm : surface_of(index, t);
                  });
  }
  for (const auto& triangle : forearms_[static_cast<std::size_t>(hand.side)].triangles)
    draw_triangle(hand.arm, triangle, front_, area, inverse_depth_.view(),
                  [&](int x, int y, float, float, float) { out.at(x, y) = kArm; });
}

}  // namespace handcast::twin
