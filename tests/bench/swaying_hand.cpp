// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/swaying_hand.hpp"

#include <cmath>

#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;

constexpr std::int64_t kExposure_ns = 1'000'000'000 / 525;
constexpr std::int64_t kTrackerPeriod_ns = 9 * kMs, kTrackerAge_ns = 9 * kMs,
                       kDetection_ns = 16 * kMs;
constexpr std::int64_t kSway_ns = 400 * kMs;  ///< one period of the motion, then it repeats
constexpr int kImages = 210;                  ///< one per exposure of a period

glm::vec3 place_at(std::int64_t time_ns) {
  constexpr double kAmplitude_m = 0.038;  // 0.6 m/s at the fastest
  return {
      static_cast<float>(kAmplitude_m *
                         std::sin(2 * M_PI * static_cast<double>(time_ns % kSway_ns) / kSway_ns)),
      0, 0};
}

}  // namespace

SwayingHand::SwayingHand(double distance_m) : calibration_(rig_above_hand()) {
  calibration_.camera_from_tracker[3].z = distance_m;
  for (int i = 0; i < kImages; ++i)
    images_.push_back(image_of(calibration_, {pose_of(Side::left, place_at(i * kExposure_ns))}));
}

void SwayingHand::deliver(Pipeline& pipeline, std::int64_t now_ns) {
  for (; next_sample_ns_ + kTrackerAge_ns <= now_ns; next_sample_ns_ += kTrackerPeriod_ns)
    pipeline.push(next_sample_ns_ + kTrackerAge_ns,
                  poses_of(next_sample_ns_, {pose_of(Side::left, place_at(next_sample_ns_))}));
  for (; next_detection_ns_ + kDetection_ns <= now_ns; next_detection_ns_ += kDetection_ns) {
    const msg::HandPose hand = pose_of(Side::left, place_at(next_detection_ns_));
    pipeline.push(next_detection_ns_ + kDetection_ns,
                  landmarks_of(calibration_, next_detection_ns_, hand, {3, 4}));
  }
}

TimedImage SwayingHand::image(std::int64_t now_ns) const {
  const std::int64_t exposure = (now_ns - 3 * kMs) / kExposure_ns;
  return {images_[static_cast<std::size_t>(exposure % kImages)].view(), exposure * kExposure_ns};
}

}  // namespace handcast::bench
