// SPDX-License-Identifier: Apache-2.0
#include "renderer/mask/hint.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace handcast::renderer {
namespace {

constexpr int kWrist = 1;
constexpr double kAlongArm_m = 0.04;
// Usual and largest error of the expected capsules.
constexpr float kSure_px = 1, kMost_px = 24;                 ///< with landmarks
constexpr float kTrackerSure_px = 20, kTrackerMost_px = 50;  ///< with the tracker alone

/// Distance of the skin from the bone at either end, of an average hand, seen from any side.
struct Bone {
  int from, to;
  float from_mm, to_mm;
};
constexpr Bone kBones[] = {
    {0, 1, 20, 20},  {1, 2, 16, 11},        {2, 3, 10.6f, 10.2f}, {3, 4, 10.2f, 8.4f},   // thumb
    {0, 5, 16, 11},  {5, 6, 10.4f, 9.2f},   {6, 7, 9.2f, 8},      {7, 8, 8, 7},          // index
    {0, 9, 16, 11},  {9, 10, 10.6f, 9.5f},  {10, 11, 9.5f, 8.2f}, {11, 12, 8.2f, 7.1f},  // middle
    {0, 13, 16, 11}, {13, 14, 10.1f, 8.9f}, {14, 15, 8.9f, 7.8f}, {15, 16, 7.8f, 6.8f},  // ring
    {0, 17, 22, 14}, {17, 18, 8.8f, 7.8f},  {18, 19, 7.8f, 6.9f}, {19, 20, 6.9f, 6.1f},  // little
    {2, 5, 11, 11},  {5, 9, 11, 11},        {9, 13, 11, 11},      {13, 17, 11, 11}};
constexpr float kWrist_mm = 28;
static_assert(std::size(kBones) + 1 == kCapsules);

/// The image position of a point in tracker space, moved by `offset_px` before the lens distortion.
glm::dvec2 image_of(const calib::Calibration& calibration, const glm::dvec3& tracker_m,
                    const glm::dvec2& offset_px) {
  const glm::dvec3 in_camera =
      glm::dvec3(calibration.camera_from_tracker * glm::dvec4(tracker_m, 1));
  return calibration.camera.distort(
      calibration.camera.project({in_camera.x, in_camera.y, std::max(in_camera.z, 0.05)}) +
      offset_px);
}

/// True up to half an image outside the image. Beyond that, the polynomial of the lens may map a
/// point back into the image.
bool is_in_reach(const calib::CameraModel& camera, const glm::dvec2& undistorted_px) {
  const glm::dvec2 size(camera.width_px, camera.height_px),
      off = glm::abs(undistorted_px - 0.5 * size);
  return off.x < size.x && off.y < size.y;
}

/// Camera px per mm at the distance of each landmark.
std::array<float, kLandmarks> scale_of(const calib::CameraModel& camera,
                                       const std::array<double, kLandmarks>& depths_m) {
  std::array<float, kLandmarks> px_per_mm;
  for (int i = 0; i < kLandmarks; ++i)
    px_per_mm[i] = static_cast<float>(1e-3 * camera.fx_px / depths_m[i]);
  return px_per_mm;
}

std::array<Capsule, kCapsules> capsules_of(const LandmarkPoints& landmarks_px, glm::vec2 arm_px,
                                           const std::array<float, kLandmarks>& px_per_mm) {
  std::array<Capsule, kCapsules> capsules;
  auto capsule = capsules.begin();
  for (const auto& [from, to, from_mm, to_mm] : kBones) {
    const glm::vec2 along = landmarks_px[to] - landmarks_px[from];
    const float radius_px = to_mm * px_per_mm[to], length_px = glm::length(along);
    // The landmark of a tip is the end of the finger, not the centre of its last disc.
    const bool tip = to % 4 == 0 && length_px > 0;
    const glm::vec2 end_px =
        tip ? landmarks_px[to] - along * (std::min(1.0f, radius_px / length_px)) : landmarks_px[to];
    *capsule++ = {landmarks_px[from], end_px, from_mm * px_per_mm[from], radius_px};
  }
  *capsule = {landmarks_px[0], arm_px, kWrist_mm * px_per_mm[0], kWrist_mm * px_per_mm[0]};
  return capsules;
}

Rect bounds_of(std::span<const Capsule> capsules, float margin_px) {
  glm::vec2 low(1e6f), high(-1e6f);
  for (const auto& [from, to, from_radius, to_radius] : capsules) {
    low = glm::min(low, glm::min(from - from_radius, to - to_radius));
    high = glm::max(high, glm::max(from + from_radius, to + to_radius));
  }
  low = glm::clamp(low - margin_px, -1e6f, 1e6f);
  high = glm::clamp(high + margin_px, -1e6f, 1e6f);
  return {static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x) + 1,
          static_cast<int>(high.y) + 1};
}

}  // namespace

std::optional<OwnedHint> make_hint(const calib::Calibration& calibration,
                                   const config::Mask& settings, const ProjectedPose& then,
                                   const LandmarkPoints& offset_px, bool has_landmarks) {
  OwnedHint owned;
  bool in_reach = false;
  for (int i = 0; i < kLandmarks; ++i) {
    const glm::dvec2 px = glm::dvec2(then.landmarks[i]) + glm::dvec2(offset_px[i]);
    in_reach |= is_in_reach(calibration.camera, px);
    owned.seeds_px[i] = calibration.camera.distort(px);
  }
  if (!in_reach) return std::nullopt;

  const auto& [x, y, z] = then.pose.joints[kWrist].position_m;
  const auto& [qx, qy, qz, qw] = then.pose.joints[kWrist].orientation_xyzw;
  const glm::dvec3 wrist(x, y, z), to_elbow = glm::dquat(qw, qx, qy, qz) * glm::dvec3(0, 0, 1);
  const glm::dvec2 offset = offset_px[0];
  const double forearm_m = settings.forearm_mm * 1e-3;
  const glm::dvec2 end = image_of(calibration, wrist + forearm_m * to_elbow, offset);
  glm::dvec2 along =
      image_of(calibration, wrist + (forearm_m + kAlongArm_m) * to_elbow, offset) - end;
  // If the arm points at the camera, its direction is that from the middle knuckle to the wrist.
  if (glm::length(along) < 2) along = owned.seeds_px[0] - owned.seeds_px[9];
  if (glm::length(along) < 1e-3) along = {0, 1};

  owned.capsules = capsules_of(owned.seeds_px, end, scale_of(calibration.camera, then.depths_m));
  owned.sure_px = has_landmarks ? kSure_px : kTrackerSure_px;
  owned.most_px = has_landmarks ? kMost_px : kTrackerMost_px;
  owned.region = bounds_of(owned.capsules, owned.most_px);
  owned.wrist_px = end;
  owned.to_elbow = glm::normalize(along);
  return owned;
}

}  // namespace handcast::renderer
