// SPDX-License-Identifier: Apache-2.0
#include "services/pose/stereo/cover.hpp"

#include <algorithm>

namespace handcast::pose::stereo {
namespace {

/// Flesh around a bone, and how far behind a bone a landmark must be.
constexpr double kFlesh_m = 0.02, kBehind_m = 0.008;

/// A landmark in a view.
struct SeenPoint {
  glm::dvec2 px;
  double depth_m;
};

std::array<SeenPoint, msg::kLandmarks> seen_in(const PosedHand& hand, const View& view) {
  std::array<SeenPoint, msg::kLandmarks> seen;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const glm::dvec3& place_m = hand.place_m[msg::kJointOfLandmark[i]];
    seen[i] = {view.project(place_m), std::max(view.in_view(place_m).z, View::kNearest_m)};
  }
  return seen;
}

/// A bone ends at each landmark but the wrist's: those of the palm begin at the wrist.
bool hides(const SeenPoint& from, const SeenPoint& to, double focal_px, const SeenPoint& point) {
  const glm::dvec2 bone_px = to.px - from.px;
  const double share = std::clamp(
      glm::dot(point.px - from.px, bone_px) / std::max(glm::dot(bone_px, bone_px), 1e-9), 0.0, 1.0);
  const double depth_m = std::lerp(from.depth_m, to.depth_m, share);
  return point.depth_m > depth_m + kBehind_m &&
         glm::distance(point.px, from.px + share * bone_px) < kFlesh_m * focal_px / depth_m;
}

}  // namespace

Hidden hidden_by(const PosedHand& other, const PosedHand& hand, const View& view) {
  const auto front = seen_in(other, view), back = seen_in(hand, view);
  Hidden hidden;
  for (int i = 0; i < msg::kLandmarks; ++i)
    for (int end = 1; end < msg::kLandmarks && !hidden[i]; ++end)
      hidden[i] = hides(front[end % 4 == 1 ? 0 : end - 1], front[end], view.camera.fx_px, back[i]);
  return hidden;
}

}  // namespace handcast::pose::stereo
