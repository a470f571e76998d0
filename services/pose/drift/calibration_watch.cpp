// SPDX-License-Identifier: Apache-2.0
#include "services/pose/drift/calibration_watch.hpp"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

#include "ipc/base/log.hpp"
#include "ipc/msg/same_calibration.hpp"

namespace handcast::pose {
namespace {

constexpr std::size_t kMostWaiting = 64;
constexpr float kLeastConfidence = 0.3f;
constexpr double kSigmaIfUnknown_px = 3;

calib::TrackedHand tracked(const msg::HandPose& hand) {
  calib::TrackedHand joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& joint = hand.joints[static_cast<std::size_t>(msg::kJointOfLandmark[i])];
    const auto& [x, y, z] = joint.position_m;
    const auto& [qx, qy, qz, qw] = joint.orientation_xyzw;
    joints[i] = {{x, y, z}, glm::mat3_cast(glm::normalize(glm::dquat(qw, qx, qy, qz)))};
  }
  return joints;
}

calib::SeenHand seen(const msg::HandLandmarks& hand) {
  calib::SeenHand points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = hand.points[i];
    if (!(point.confidence >= kLeastConfidence)) continue;
    points[i] = {{point.x_px, point.y_px},
                 point.sigma_px > 0 ? double{point.sigma_px} : kSigmaIfUnknown_px};
  }
  return points;
}

bool is_on(const config::Drift& settings, const calib::Calibration& calibration) {
  return settings.watch == config::DriftWatch::always ||
         (settings.watch == config::DriftWatch::measured && !calibration.made.tracker.empty());
}

}  // namespace

CalibrationWatch::CalibrationWatch(const config::Drift& settings,
                                   const calib::Calibration& calibration)
    : calibration_(calibration.id) {
  if (pose::is_on(settings, calibration))
    watch_.emplace(calibration, calib::DriftLimits{settings.warn_mm, settings.warn_deg});
}

void CalibrationWatch::see(const msg::HandPoses& poses) {
  if (!watch_) return;
  for (const auto side : {msg::Side::left, msg::Side::right})
    if (const auto* hand = poses.find(side))
      watch_->add(static_cast<std::size_t>(side), poses.header.origin_ns, tracked(*hand));
  while (!waiting_.empty() && waiting_.front().header.origin_ns < poses.header.origin_ns) {
    take(waiting_.front());
    waiting_.pop_front();
  }
}

void CalibrationWatch::see(const msg::Landmarks& landmarks) {
  if (!watch_ || !msg::check_calibration(landmarks, calibration_)) return;
  waiting_.push_back(landmarks);
  if (waiting_.size() > kMostWaiting) waiting_.pop_front();
}

void CalibrationWatch::take(const msg::Landmarks& landmarks) {
  for (const auto side : {msg::Side::left, msg::Side::right})
    if (const auto* hand = landmarks.find(side))
      watch_->add(static_cast<std::size_t>(side), landmarks.header.origin_ns, seen(*hand));
}

msg::DriftNote CalibrationWatch::note() const {
  const auto known = drift();
  return {known.moved, static_cast<std::uint32_t>(known.places), known.across_mm, known.turn_deg};
}

void DriftLog::tell(const calib::Drift& drift) {
  if (drift.moved == told_) return;
  told_ = drift.moved;
  if (drift.moved)
    log::warning(
        "the tracker has moved against the camera since the calibration: by {:.1f} mm +- {:.1f} "
        "and {:.2f} degrees +- {:.2f}, by {} places of still hands; fasten it, then `handcast "
        "calibrate RIG.toml --correct` corrects the calibration, and --undo takes that back",
        drift.across_mm, 2 * drift.across_sd_mm, drift.turn_deg, 2 * drift.turn_sd_deg,
        drift.places);
  else
    log::info("the tracker is where the calibration says again");
}

}  // namespace handcast::pose
