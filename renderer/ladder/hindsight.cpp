// SPDX-License-Identifier: Apache-2.0
#include "renderer/ladder/hindsight.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/base/clock.hpp"
#include "renderer/base/similarity.hpp"

namespace handcast::renderer {
namespace {

constexpr std::int64_t kApart_ns =
    3'000'000;  ///< between frames that are kept: some three for every tracker sample
constexpr std::size_t kMostWaiting = 32;
constexpr float kRise_s = 0.1f,
                kFall_s = 0.3f;  ///< over which errors that grow, and that fall, are averaged
constexpr float kTrust_s = 1.0f;
constexpr float kRegisterNoise_px = 0.15f;  ///< what registration alone is off by in an image

float rms(const LandmarkPoints& a, const LandmarkPoints& b) {
  float sum = 0;
  for (int i = 0; i < kLandmarks; ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / static_cast<float>(kLandmarks));
}

float share_left(std::int64_t span_ns, float span_s) {
  return std::exp(-static_cast<float>(ns_to_seconds(span_ns)) / span_s);
}

/// A prediction's error grows as the square of the time it reaches ahead: what it is at the light,
/// for 1 px at the exposure. Held back where the exposure is hardly ahead of the newest sample, for
/// then it tells little.
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
              trust_left = share_left(since_ns, kTrust_s);

  const float carried = carried_on(frame);
  const Similarity seen = fit_similarity(frame.at_camera, at_camera);
  LandmarkPoints reckoned, measured;
  for (int i = 0; i < kLandmarks; ++i) {
    reckoned[i] = glm::mix(frame.at_target[i], seen(frame.at_target[i]), carried);
    measured[i] = frame.registered ? frame.at_target[i] + (*frame.registered)[i] : reckoned[i];
  }
  const float noise_px = carried * kRegisterNoise_px;
  const float reckoned_px = std::hypot(rms(reckoned, at_target), noise_px);
  const float measured_px = rms(measured, at_target);
  if (frame.registered) {
    trust_.measured_px = std::lerp(measured_px, trust_.measured_px, trust_left);
    trust_.reckoned_px = std::lerp(reckoned_px, trust_.reckoned_px, trust_left);
  }
  const auto follow = [=](float& followed, float now) {
    followed = std::lerp(now, followed, now > followed ? rise_left : fall_left);
  };
  follow(motion_.hold_px, rms(frame.newest, at_target));
  follow(motion_.predict_px, rms(frame.at_target, at_target));
  follow(motion_.register_px,
         frame.registered ? measured_px : reckoned_px * trust_.measured_px / trust_.reckoned_px);
}

}  // namespace handcast::renderer
