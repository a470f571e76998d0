#include "renderer/pipeline/hand_track.hpp"

namespace handcast::renderer {
namespace {

constexpr double kNearest_m = 0.05;

}  // namespace

std::optional<LandmarkPoints> project_landmarks(const calib::Calibration& calibration, const msg::HandPose& pose) {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) {
    const auto& [x, y, z] = pose.joints[msg::kJointOfLandmark[i]].position_m;
    const glm::dvec3 in_camera = glm::dvec3(calibration.camera_from_tracker * glm::dvec4(x, y, z, 1));
    if (!(in_camera.z > kNearest_m)) return std::nullopt;
    points[i] = calibration.camera.project(in_camera);
  }
  return points;
}

HandTrack::HandTrack(const config::Cascade& settings, const calib::Calibration& calibration, LandmarkOracle oracle)
    : calibration_(calibration), history_(settings.predict), filter_(make_landmark_filter(settings.filter, std::move(oracle))) {}

void HandTrack::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandPose& pose) {
  history_.push(origin_ns, pose);
  filter_->tracker_sample(now_ns);
}

void HandTrack::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  filter_->detection(now_ns, origin_ns, seen, [this](std::int64_t time_ns) -> std::optional<LandmarkPoints> {
    const auto pose = history_.at(time_ns);
    return pose ? project_landmarks(calibration_, *pose) : std::nullopt;
  });
}

std::optional<HandTrack::Tracked> HandTrack::at(std::int64_t now_ns, std::int64_t target_ns) {
  const auto pose = history_.at(target_ns);
  if (!pose) return std::nullopt;
  const auto tracker = project_landmarks(calibration_, *pose);
  if (!tracker) return std::nullopt;
  const auto corrected = filter_->at(now_ns, target_ns, *tracker);
  return Tracked{*pose, *tracker, corrected.value_or(*tracker), corrected.has_value()};
}

}  // namespace handcast::renderer
