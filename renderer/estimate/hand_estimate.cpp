// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/hand_estimate.hpp"

#include "ipc/base/clock.hpp"
#include "renderer/estimate/articulated_hand.hpp"
#include "renderer/estimate/error_priors.hpp"
#include "renderer/estimate/known_errors.hpp"

namespace handcast::renderer {
namespace {

LandmarkPoints points_px(const msg::HandLandmarks& seen) {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i) points[i] = position_px(seen.points[i]);
  return points;
}

}  // namespace

HandEstimate::HandEstimate(const calib::Calibration& calibration)
    : calibration_(calibration), known_(std::make_unique<KnownErrors>()) {}
HandEstimate::~HandEstimate() = default;
HandEstimate::HandEstimate(HandEstimate&&) noexcept = default;
HandEstimate& HandEstimate::operator=(HandEstimate&&) noexcept = default;

void HandEstimate::detection(std::int64_t origin_ns, const msg::HandLandmarks& seen) {
  if (!waiting_ && origin_ns - last_ns_ >= kShortest_ns) waiting_ = Waiting{origin_ns, seen};
}

void HandEstimate::look_back(const HandTrack& track) {
  if (!waiting_ || track.newest_ns() < waiting_->origin_ns) return;
  const auto [origin_ns, seen] = *waiting_;
  waiting_.reset();
  const auto pose = track.recent_pose(origin_ns);
  if (!pose || origin_ns < track.begins_ns()) return;
  const auto reported = in_camera(calibration_, *pose);
  const auto abrupt =
      abruptness_.add({origin_ns, landmarks_px(reported), points_px(seen), flexions_of(reported)});
  rest_share_ = rest_.add(origin_ns, seen);
  last_ns_ = origin_ns;
  if (known_->add(calibration_.camera, {origin_ns, reported, seen, abrupt, rest_share_}))
    explained_ns_ = origin_ns;
  else if (origin_ns - explained_ns_ > kMoved_ns)
    known_->doubt_place();
}

/// Where the tracker has the landmarks.
LandmarkPoints HandEstimate::landmarks_px(const HandJoints& reported) const {
  LandmarkPoints points;
  for (int i = 0; i < kLandmarks; ++i)
    points[i] = calibration_.camera.project(reported.at_m[joint_of_landmark(i)]);
  return points;
}

void HandEstimate::tracker_jumped() {
  known_->doubt_place();
  abruptness_.forget();
  waiting_.reset();
  explained_ns_ = 0;
}

bool HandEstimate::knows() const { return explained_ns_ != 0 && explained_ns_ == last_ns_; }

msg::HandPose HandEstimate::corrected(std::int64_t time_ns, const msg::HandPose& reported) const {
  const ArticulatedHand hand(in_camera(calibration_, reported), errors_at(time_ns));
  return in_tracker(calibration_, hand.joints(), reported);
}

HandErrors HandEstimate::errors_at(std::int64_t time_ns) const {
  return known_->errors_at(time_ns);
}

}  // namespace handcast::renderer
