// SPDX-License-Identifier: Apache-2.0
#include "renderer/ladder/hindsight.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/base/similarity.hpp"

namespace handcast::renderer {
namespace {

/// Least time between frames that are kept: about three per tracker sample.
constexpr std::int64_t kApart_ns = 3'000'000;
/// Time constants of the means of errors that grow, and that fall.
constexpr float kRise_s = 0.1f, kFall_s = 0.3f;
constexpr float kRegistration_s = 1.0f;
/// Error of registration alone at the time of the image.
constexpr float kRegisterNoise_px = 0.15f;
/// Least divisor for estimated errors, which are 0 if predictions of a tracker without noise are
/// exact.
constexpr float kLeastEstimate_px = 1e-3f;

float rms(const LandmarkPoints& a, const LandmarkPoints& b) {
  float sum = 0;
  for (int i = 0; i < kLandmarks; ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / static_cast<float>(kLandmarks));
}

float share_left(std::int64_t span_ns, float span_s) {
  return std::exp(-static_cast<float>(ns_to_seconds(span_ns)) / span_s);
}

/// The error of a prediction at the target time for 1 px of error at the exposure. It grows with
/// the square of the time since the newest sample. The factor is reduced if the exposure is not
/// much later than that sample, because then its error is mostly noise.
float carried_on(const Hindsight::Frame& frame) {
  constexpr float kTelling_ms = 5;
  const auto ahead_ms = [&](std::int64_t time_ns) {
    return static_cast<float>(ns_to_ms(std::max<std::int64_t>(0, time_ns - frame.newest_ns)));
  };
  const float camera = ahead_ms(frame.camera_ns), target = ahead_ms(frame.target_ns);
  return camera * camera * target * target / (std::pow(kTelling_ms, 4.0f) + std::pow(camera, 4.0f));
}

}  // namespace

bool Hindsight::wants(std::int64_t target_ns) const {
  return waiting_.empty() || target_ns - waiting_.back().target_ns >= kApart_ns;
}

void Hindsight::remember(const Frame& frame) {
  if (waiting_.size() == kMostWaiting) waiting_.pop_front();
  waiting_.push_back(frame);
}

void Hindsight::registered(std::int64_t target_ns, const LandmarkPoints& moved_px) {
  if (!waiting_.empty() && waiting_.back().target_ns == target_ns)
    waiting_.back().registered = moved_px;
}

void Hindsight::look_back(const HandTrack& track) {
  for (; !waiting_.empty() && waiting_.front().target_ns <= track.newest_ns();
       waiting_.pop_front()) {
    const auto then = track.landmarks_at(waiting_.front().target_ns);
    const auto at_camera = track.landmarks_at(waiting_.front().camera_ns);
    if (then && at_camera) compare(waiting_.front(), *at_camera, *then);
  }
}

void Hindsight::compare(const Frame& frame, const LandmarkPoints& at_camera,
                        const LandmarkPoints& at_target) {
  const std::int64_t since_ns = std::max<std::int64_t>(0, frame.target_ns - compared_ns_);
  compared_ns_ = frame.target_ns;
  const float rise_left = share_left(since_ns, kRise_s), fall_left = share_left(since_ns, kFall_s),
              registration_left = share_left(since_ns, kRegistration_s);

  const float carried = carried_on(frame);
  const Similarity seen = fit_similarity(frame.at_camera, at_camera);
  LandmarkPoints estimated, measured;
  for (int i = 0; i < kLandmarks; ++i) {
    estimated[i] = glm::mix(frame.at_target[i], seen(frame.at_target[i]), carried);
    measured[i] = frame.registered ? frame.at_target[i] + (*frame.registered)[i] : estimated[i];
  }
  const float noise_px = carried * kRegisterNoise_px;
  const float estimated_px = std::hypot(rms(estimated, at_target), noise_px);
  const float measured_px = rms(measured, at_target);
  if (frame.registered) {
    registration_errors_.measured_px =
        std::lerp(measured_px, registration_errors_.measured_px, registration_left);
    registration_errors_.estimated_px =
        std::lerp(estimated_px, registration_errors_.estimated_px, registration_left);
  }
  const auto follow = [=](float& followed, float now) {
    followed = std::lerp(now, followed, now > followed ? rise_left : fall_left);
  };
  follow(motion_.hold_px, rms(frame.newest, at_target));
  follow(motion_.predict_px, rms(frame.at_target, at_target));
  const float correction = registration_errors_.measured_px /
                           std::max(registration_errors_.estimated_px, kLeastEstimate_px);
  follow(motion_.register_px, frame.registered ? measured_px : estimated_px * correction);
}

}  // namespace handcast::renderer
