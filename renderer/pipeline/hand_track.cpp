#include "renderer/pipeline/hand_track.hpp"

#include <utility>

namespace handcast::renderer {
namespace {

constexpr double kNearest_m = 0.05;
constexpr int kSeenAgain = 2;  ///< detections until a tracker that comes back is known again

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
  const auto pushed = history_.push(origin_ns, pose);
  if (pushed == PoseHistory::Pushed::not_measured) return;
  if (pushed == PoseHistory::Pushed::begins_anew) filter_->tracker_jumped();
  heard_ns_ = now_ns;
  news_ = true;
  filter_->tracker_sample(now_ns);
}

void HandTrack::push(std::int64_t now_ns, std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  if (!seen_ns_ || origin_ns > *seen_ns_) seen_ns_ = origin_ns;
  ++seen_again_;
  news_ = true;
  filter_->detection(now_ns, origin_ns, seen, [this](std::int64_t time_ns) -> std::optional<LandmarkPoints> {
    if (time_ns < history_.begins_ns()) return std::nullopt;
    const auto pose = history_.at(time_ns);
    return pose ? project_landmarks(calibration_, *pose) : std::nullopt;
  });
}

std::optional<HandTrack::Tracked> HandTrack::at(std::int64_t now_ns, std::int64_t target_ns) {
  const auto pose = pose_at(target_ns);
  const auto tracker = pose ? project_landmarks(calibration_, *pose) : std::nullopt;
  if (!tracker) {
    presence_.gone(target_ns);
    return std::nullopt;
  }
  const bool silent = now_ns - heard_ns_ > history_.patience_ns() || !history_.settled();
  const bool news = std::exchange(news_, false) || silent != std::exchange(silent_, silent);
  if (silent) seen_again_ = 0;
  alone_ = silent || (alone_ && seen_again_ < kSeenAgain);
  filter_->tracker_is(silent ? LandmarkFilter::Tracker::silent : LandmarkFilter::Tracker::heard);
  const auto corrected = filter_->at(now_ns, target_ns, *tracker);
  const float presence = presence_.at(target_ns, history_.newest_ns(), corrected ? seen_ns_ : std::nullopt);
  if (presence == 0) return std::nullopt;
  const Tracked tracked{*pose, *tracker, corrected.value_or(*tracker), corrected.has_value(), alone_, news, presence};
  for (int i = 0; i < kLandmarks; ++i) moved_px_[i] = tracked.corrected[i] - tracked.tracker[i];
  return tracked;
}

std::optional<LandmarkPoints> HandTrack::landmarks_at(std::int64_t time_ns) const {
  const auto pose = history_.at(time_ns);
  auto points = pose ? project_landmarks(calibration_, *pose) : std::nullopt;
  if (points)
    for (int i = 0; i < kLandmarks; ++i) (*points)[i] += moved_px_[i];
  return points;
}

}  // namespace handcast::renderer
