// SPDX-License-Identifier: Apache-2.0
#include "services/lab/twin/surface.hpp"

#include <algorithm>
#include <numbers>

#include "services/lab/twin/finger_pose.hpp"

namespace handcast::twin {
namespace {

constexpr int kAround = 24;
constexpr float kElbow_m = 0.34f;        ///< end of the forearm behind the wrist
constexpr float kOverlap_m = 0.01f;      ///< of hand and forearm
constexpr float kLongestStub_m = 0.06f;  ///< a hand that is longer is cut here
constexpr float kSleeveBrightness = 1.35f;

/// Half axes of a bare forearm at a distance behind the wrist. It begins inside the hand's stub and
/// becomes thicker and rounder towards the elbow.
glm::vec2 half_axes_at(glm::vec2 wrist, float begin_m, float behind_m) {
  const float u = std::clamp((behind_m - begin_m) / 0.2f, 0.0f, 1.0f);
  const glm::vec2 elbow(wrist.x * 1.6f, wrist.y * 2.1f);
  return glm::mix(wrist * 0.96f, elbow, u * u * (3 - 2 * u));
}

void add_ring(Forearm& arm, float behind_m, glm::vec2 half_axes, float brightness) {
  for (int i = 0; i < kAround; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
    const glm::vec2 d(std::cos(angle), std::sin(angle));
    arm.positions.emplace_back(half_axes.x * d.x, half_axes.y * d.y, behind_m);
    arm.normals.push_back(glm::normalize(glm::vec3(d.x / half_axes.x, d.y / half_axes.y, 0)));
    arm.brightness.push_back(brightness);
  }
}

/// Joins the last two rings with triangles that are counter-clockwise seen from outside.
void join_rings(Forearm& arm) {
  const auto last = static_cast<std::uint16_t>(arm.positions.size() - kAround);
  const auto before = static_cast<std::uint16_t>(last - kAround);
  for (std::uint16_t i = 0; i < kAround; ++i) {
    const auto next = static_cast<std::uint16_t>((i + 1) % kAround);
    const auto at = [](int base, int k) { return static_cast<std::uint16_t>(base + k); };
    arm.triangles.push_back({at(before, i), at(before, next), at(last, i)});
    arm.triangles.push_back({at(before, next), at(last, next), at(last, i)});
  }
}

/// Half axes of the hand's stub where the forearm begins.
glm::vec2 half_axes_of(const renderer::HandMesh& hand, float begin_m) {
  const glm::mat4 wrist_from_model = glm::inverse(hand.rest[1]);
  glm::vec2 half_axes(0.01f);
  for (const glm::vec3& position : hand.positions) {
    const glm::vec3 p(wrist_from_model * glm::vec4(position, 1));
    if (p.z > begin_m - kOverlap_m && p.z < begin_m + kOverlap_m)
      half_axes = glm::max(half_axes, glm::abs(glm::vec2(p)));
  }
  return half_axes;
}

}  // namespace

std::vector<float> behind_wrist_m(const renderer::HandMesh& hand) {
  const glm::mat4 wrist_from_model = glm::inverse(hand.rest[1]);
  std::vector<float> behind;
  for (const glm::vec3& position : hand.positions)
    behind.push_back((wrist_from_model * glm::vec4(position, 1)).z);
  return behind;
}

std::vector<int> fingers_of(const renderer::HandMesh& hand) {
  std::vector<int> fingers;
  for (std::size_t v = 0; v < hand.vertex_count(); ++v) {
    const auto& weights = hand.weights[v];
    const int joint = hand.joints[v][static_cast<std::size_t>(std::ranges::max_element(weights) -
                                                              weights.begin())];
    fingers.push_back(finger_of_joint(joint));
  }
  return fingers;
}

Forearm make_forearm(const renderer::HandMesh& hand, float sleeve_m) {
  const auto behind_m = behind_wrist_m(hand);
  const float begin_m = std::min(*std::ranges::max_element(behind_m), kLongestStub_m) - kOverlap_m;
  const glm::vec2 wrist_half_axes_m = half_axes_of(hand, begin_m);
  Forearm arm;
  for (int ring = 0; ring <= 6; ++ring) {
    const float behind = begin_m + (kElbow_m - begin_m) * static_cast<float>(ring) / 6;
    add_ring(arm, behind, half_axes_at(wrist_half_axes_m, begin_m, behind), 1);
    if (ring > 0) join_rings(arm);
  }
  if (sleeve_m >= kElbow_m) return arm;
  constexpr float kCloth_m = 0.007f;
  // The first ring lies inside the arm and closes the cuff.
  add_ring(arm, sleeve_m, half_axes_at(wrist_half_axes_m, begin_m, sleeve_m) * 0.9f,
           kSleeveBrightness);
  for (int ring = 0; ring <= 4; ++ring) {
    const float behind = sleeve_m + (kElbow_m - sleeve_m) * static_cast<float>(ring) / 4;
    add_ring(arm, behind, half_axes_at(wrist_half_axes_m, begin_m, behind) * 1.08f + kCloth_m,
             kSleeveBrightness);
    join_rings(arm);
  }
  return arm;
}

renderer::Rect ScreenVertices::bounds() const {
  if (x.empty()) return {};
  const auto [x0, x1] = std::minmax_element(x.begin(), x.end());
  const auto [y0, y1] = std::minmax_element(y.begin(), y.end());
  const auto bounded = [](float v) { return v > -1e5f ? std::min(v, 1e5f) : -1e5f; };  // NaN, too
  const auto low = [&](float v) { return static_cast<int>(std::floor(bounded(v))); };
  const auto high = [&](float v) { return static_cast<int>(std::ceil(bounded(v))) + 1; };
  return {low(*x0), low(*y0), high(*x1), high(*y1)};
}

}  // namespace handcast::twin
