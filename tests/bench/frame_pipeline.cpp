// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/frame_pipeline.hpp"

#include <cmath>

#include "renderer/pipeline/pipeline.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/renderer/pipeline/stage_set.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;

constexpr std::int64_t kFrame_ns = 1'000'000'000 / 946, kExposure_ns = 1'000'000'000 / 525;
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

/// What the camera saw, made beforehand: pictures are slow to make.
std::vector<Image<std::uint8_t>> make_images(const calib::Calibration& calibration) {
  std::vector<Image<std::uint8_t>> images;
  for (int i = 0; i < kImages; ++i)
    images.push_back(image_of(calibration, {pose_of(Side::left, place_at(i * kExposure_ns))}));
  return images;
}

}  // namespace

FrameTimes time_frames(const config::Cascade& cascade, double distance_m, int frames) {
  calib::Calibration calibration = rig_above_hand();
  calibration.camera_from_tracker[3].z = distance_m;
  FrameTimes times;
  const auto pipeline = Pipeline::create(cascade, {}, {}, calibration);
  if (!pipeline) {
    times.error = pipeline.error().what;
    return times;
  }
  const std::vector<Image<std::uint8_t>> images = make_images(calibration);
  constexpr int kWarmUp = 100;
  std::int64_t next_sample_ns = 0, next_detection_ns = 0;
  for (int i = 0; i < kWarmUp + frames; ++i) {
    const std::int64_t now_ns = 300 * kMs + i * kFrame_ns;
    for (; next_sample_ns + kTrackerAge_ns <= now_ns; next_sample_ns += kTrackerPeriod_ns) {
      (*pipeline)->push(next_sample_ns + kTrackerAge_ns,
                        poses_of(next_sample_ns, {pose_of(Side::left, place_at(next_sample_ns))}));
    }
    for (; next_detection_ns + kDetection_ns <= now_ns; next_detection_ns += kDetection_ns) {
      const msg::HandPose hand = pose_of(Side::left, place_at(next_detection_ns));
      (*pipeline)->push(next_detection_ns + kDetection_ns,
                        landmarks_of(calibration, next_detection_ns, hand, {3, 4}));
    }
    const std::int64_t exposure = (now_ns - 3 * kMs) / kExposure_ns;
    const Image<std::uint8_t>& image = images[static_cast<std::size_t>(exposure % kImages)];
    Frame frame;
    const double frame_us = timed_us([&] {
      frame =
          (*pipeline)->render(now_ns, now_ns + 4 * kMs, {image.view(), exposure * kExposure_ns});
    });
    times.lit_px = frame.fill.lit;
    times.filled_px = frame.fill.filled;
    if (i < kWarmUp) continue;
    times.frame_us.push_back(frame_us);
    for (const msg::StageMark& mark : frame.stages) {
      times.stage_us[std::string(msg::kStageNames[static_cast<std::size_t>(mark.stage)])].push_back(
          (mark.end_ns - mark.begin_ns) / 1e3);
    }
  }
  return times;
}

}  // namespace handcast::bench
