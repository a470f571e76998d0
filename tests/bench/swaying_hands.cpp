// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/swaying_hands.hpp"

#include <algorithm>
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
constexpr float kAside_m = 0.085f;            ///< of two hands

glm::vec3 place_at(std::int64_t time_ns) {
  constexpr double kAmplitude_m = 0.038;  // 0.6 m/s at the fastest
  return {
      static_cast<float>(kAmplitude_m *
                         std::sin(2 * M_PI * static_cast<double>(time_ns % kSway_ns) / kSway_ns)),
      0, 0};
}

}  // namespace

calib::Calibration rig_above_hands(double distance_m) {
  calib::Calibration rig = rig_above_hand();
  rig.camera_from_tracker[3].z = distance_m;
  return rig;
}

SwayingHands::SwayingHands(const calib::Calibration& rig, int hands,
                           const renderer::samples::Pose& pose)
    : rig_(rig) {
  const auto add = [&](Side side, float aside_m) {
    hands_.push_back({side, posed(*load_hand_or_default({}, side), pose), aside_m});
  };
  add(Side::left, hands == 1 ? 0 : -kAside_m);
  if (hands > 1) add(Side::right, kAside_m);
  for (int i = 0; i < kImages; ++i) images_.push_back(image_at(i * kExposure_ns));
}

void SwayingHands::deliver(Pipeline& pipeline, std::int64_t now_ns) {
  for (; next_sample_ns_ + kTrackerAge_ns <= now_ns; next_sample_ns_ += kTrackerPeriod_ns)
    pipeline.push(next_sample_ns_ + kTrackerAge_ns, reported(next_sample_ns_));
  for (; next_detection_ns_ + kDetection_ns <= now_ns; next_detection_ns_ += kDetection_ns)
    pipeline.push(next_detection_ns_ + kDetection_ns, detected(next_detection_ns_));
}

TimedImage SwayingHands::image(std::int64_t now_ns) const {
  const std::int64_t exposure = (now_ns - 3 * kMs) / kExposure_ns;
  return {images_[static_cast<std::size_t>(exposure % kImages)].view(), exposure * kExposure_ns};
}

std::vector<msg::HandPose> SwayingHands::poses_at(std::int64_t time_ns) const {
  std::vector<msg::HandPose> poses;
  for (const Hand& hand : hands_)
    poses.push_back(
        pose_of(hand.side, hand.joints, place_at(time_ns) + glm::vec3(hand.aside_m, 0, 0)));
  return poses;
}

Image<std::uint8_t> SwayingHands::image_at(std::int64_t time_ns) const {
  Image<std::uint8_t> image(rig_.camera.width_px, rig_.camera.height_px);
  for (const msg::HandPose& pose : poses_at(time_ns)) {
    const Image<std::uint8_t> one = image_of(rig_, {pose});
    std::ranges::transform(one.pixels(), image.pixels(), image.pixels().begin(),
                           [](auto a, auto b) { return std::max(a, b); });
  }
  return image;
}

msg::HandPoses SwayingHands::reported(std::int64_t time_ns) const {
  msg::HandPoses all = poses_of(time_ns, {});
  for (const msg::HandPose& pose : poses_at(time_ns)) all.hands[all.count++] = pose;
  return all;
}

msg::Landmarks SwayingHands::detected(std::int64_t time_ns) const {
  msg::Landmarks all;
  for (const msg::HandPose& pose : poses_at(time_ns)) {
    const msg::Landmarks one = landmarks_of(rig_, time_ns, pose, {3, 4});
    all.header = one.header;
    all.hands[all.count++] = one.hands[0];
  }
  return all;
}

}  // namespace handcast::bench
