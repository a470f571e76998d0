#include "renderer/pipeline/hint.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace handcast::renderer {
namespace {

constexpr int kWrist = 1;
constexpr double kFlesh_m = 0.022;         ///< skin is at most this far from a landmark, seen from any side
constexpr double kLandmarkMargin_px = 10;  ///< what the prediction may be wrong by with landmarks,
constexpr double kTrackerMargin_px = 50;   ///< and with the tracker alone
constexpr double kAlongArm_m = 0.04;

/// A tracker point as the camera's image shows it, moved by `offset_px` before the lens.
glm::dvec2 image_of(const calib::Calibration& calibration, const glm::dvec3& tracker_m, const glm::dvec2& offset_px) {
  const glm::dvec3 in_camera = glm::dvec3(calibration.camera_from_tracker * glm::dvec4(tracker_m, 1));
  return calibration.camera.distort(calibration.camera.project({in_camera.x, in_camera.y, std::max(in_camera.z, 0.05)}) + offset_px);
}

Rect bounds_of(const std::vector<glm::vec2>& points, double margin_px) {
  glm::vec2 low = points.front(), high = points.front();
  for (const glm::vec2& point : points) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  low = glm::clamp(low - static_cast<float>(margin_px), -1e6f, 1e6f);
  high = glm::clamp(high + static_cast<float>(margin_px), -1e6f, 1e6f);
  return {static_cast<int>(low.x), static_cast<int>(low.y), static_cast<int>(high.x) + 1, static_cast<int>(high.y) + 1};
}

}  // namespace

std::optional<OwnedHint> make_hint(const calib::Calibration& calibration, const config::Mask& settings, const msg::HandPose& then,
                                   const HandTrack::Tracked& tracked) {
  const auto points = project_landmarks(calibration, then);
  if (!points) return std::nullopt;
  OwnedHint owned;
  for (int i = 0; i < kLandmarks; ++i)
    owned.seeds_px.push_back(calibration.camera.distort(glm::dvec2((*points)[i]) + glm::dvec2(tracked.corrected[i] - tracked.tracker[i])));

  const auto& [x, y, z] = then.joints[kWrist].position_m;
  const auto& [qx, qy, qz, qw] = then.joints[kWrist].orientation_xyzw;
  const glm::dvec3 wrist(x, y, z), to_elbow = glm::dquat(qw, qx, qy, qz) * glm::dvec3(0, 0, 1);
  const glm::dvec2 offset = tracked.corrected[0] - tracked.tracker[0];
  const double forearm_m = settings.forearm_mm * 1e-3;
  const glm::dvec2 end = image_of(calibration, wrist + forearm_m * to_elbow, offset);
  glm::dvec2 along = image_of(calibration, wrist + (forearm_m + kAlongArm_m) * to_elbow, offset) - end;
  if (glm::length(along) < 2) along = owned.seeds_px[0] - owned.seeds_px[9];  // the arm points at the camera: from middle knuckle to wrist
  if (glm::length(along) < 1e-3) along = {0, 1};

  const double distance_m = (calibration.camera_from_tracker * glm::dvec4(wrist, 1)).z;
  const double margin_px =
      kFlesh_m * calibration.camera.fx_px / std::max(distance_m, 0.05) + (tracked.has_landmarks ? kLandmarkMargin_px : kTrackerMargin_px);
  owned.hint = {bounds_of(owned.seeds_px, margin_px), end, glm::normalize(along), {}};
  owned.hint.inside_px = owned.seeds_px;
  return owned;
}

}  // namespace handcast::renderer
