// SPDX-License-Identifier: Apache-2.0
#include "renderer/estimate/hand_estimate.hpp"

#include <algorithm>

#include "ipc/base/clock.hpp"
#include "renderer/estimate/articulated_hand.hpp"
#include "renderer/estimate/error_filter.hpp"
#include "renderer/estimate/error_priors.hpp"

namespace handcast::renderer {

HandEstimate::HandEstimate(const calib::Calibration& calibration)
    : calibration_(calibration), filter_(std::make_unique<ErrorFilter>()) {}
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
  if (knows()) filter_->pass(ns_to_seconds(origin_ns - last_ns_), flexions_of(reported));
  filter_->update(calibration_.camera, reported, seen);
  last_ns_ = origin_ns;
}

void HandEstimate::tracker_jumped() {
  filter_->forget_place();
  waiting_.reset();
  last_ns_ = 0;
}

bool HandEstimate::knows() const { return last_ns_ != 0; }

msg::HandPose HandEstimate::corrected(std::int64_t time_ns, const msg::HandPose& reported) const {
  const ArticulatedHand hand(in_camera(calibration_, reported), errors_at(time_ns));
  return in_tracker(calibration_, hand.joints(), reported);
}

HandErrors HandEstimate::errors_at(std::int64_t time_ns) const {
  return filter_->errors_after(std::max(0.0, ns_to_seconds(time_ns - last_ns_)));
}

}  // namespace handcast::renderer
