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
constexpr float kAside_m = 0.085f;            ///< of two hands

glm::vec3 place_at(std::int64_t time_ns) {
  constexpr double kAmplitude_m = 0.038;  // 0.6 m/s at the fastest
  return {
      static_cast<float>(kAmplitude_m *
                         std::sin(2 * M_PI * static_cast<double>(time_ns % kSway_ns) / kSway_ns)),
      0, 0};
}

/// The reference rig at the distance of the scene, with the screen and the image grown around their
/// centres.
calib::Calibration rig_of(const FrameScene& scene) {
  calib::Calibration rig = rig_above_hand();
  rig.camera_from_tracker[3].z = scene.distance_m;
  const auto shift = [](glm::dvec2 by) { return glm::dmat3(1, 0, 0, 0, 1, 0, by.x, by.y, 1); };
  const glm::dvec2 more_image(0.5 * (scene.image_width_px - rig.camera.width_px),
                              0.5 * (scene.image_height_px - rig.camera.height_px)),
      more_screen(0.5 * (scene.screen_width_px - rig.projector_width_px),
                  0.5 * (scene.screen_height_px - rig.projector_height_px));
  rig.camera.cx_px += more_image.x;
  rig.camera.cy_px += more_image.y;
  rig.camera.width_px = scene.image_width_px;
  rig.camera.height_px = scene.image_height_px;
  rig.projector_from_camera = shift(more_screen) * rig.projector_from_camera * shift(-more_image);
  rig.projector_width_px = scene.screen_width_px;
  rig.projector_height_px = scene.screen_height_px;
  return rig;
}

/// One scene, frame by frame.
class Run {
 public:
  static Result<std::unique_ptr<Run>> start(const FrameScene& scene) {
    auto run = std::make_unique<Run>();
    run->rig_ = rig_of(scene);
    auto pipeline =
        Pipeline::create(scene.cascade, {.smooth = scene.smooth}, config::Hand{}, run->rig_);
    if (!pipeline) return tl::make_unexpected(pipeline.error());
    run->pipeline_ = std::move(*pipeline);
    for (const Side side : {Side::left, Side::right}) {
      if (side == Side::right && scene.hands == 1) continue;
      const auto mesh = load_hand_or_default({}, side);
      if (!mesh) return tl::make_unexpected(mesh.error());
      run->hands_.push_back({side, posed(*mesh, scene.pose),
                             scene.hands == 1      ? 0
                             : side == Side::right ? kAside_m
                                                   : -kAside_m});
    }
    // What the camera saw, made beforehand: pictures are slow to make.
    for (int i = 0; i < kImages; ++i) run->images_.push_back(run->image_at(i * kExposure_ns));
    return run;
  }

  void render(int frame_index, FrameTimes& times, bool counts) {
    const std::int64_t now_ns = 300 * kMs + frame_index * kFrame_ns;
    for (; next_sample_ns_ + kTrackerAge_ns <= now_ns; next_sample_ns_ += kTrackerPeriod_ns)
      pipeline_->push(next_sample_ns_ + kTrackerAge_ns, reported(next_sample_ns_));
    for (; next_detection_ns_ + kDetection_ns <= now_ns; next_detection_ns_ += kDetection_ns)
      pipeline_->push(next_detection_ns_ + kDetection_ns, detected(next_detection_ns_));
    const std::int64_t exposure = (now_ns - 3 * kMs) / kExposure_ns;
    const Image<std::uint8_t>& image = images_[static_cast<std::size_t>(exposure % kImages)];
    Frame frame;
    const double frame_us = timed_us([&] {
      frame = pipeline_->render(now_ns, now_ns + 4 * kMs, {image.view(), exposure * kExposure_ns});
    });
    times.lit_px = frame.fill.lit;
    times.filled_px = frame.fill.filled;
    if (!counts) return;
    times.frame_us.push_back(frame_us);
    for (const msg::StageMark& mark : frame.stages)
      times.stage_us[std::string(msg::kStageNames[static_cast<std::size_t>(mark.stage)])].push_back(
          static_cast<double>(mark.end_ns - mark.begin_ns) / 1e3);
  }

 private:
  struct Hand {
    Side side;
    JointFrames joints;
    float aside_m;
  };

  msg::HandPose pose_at(const Hand& hand, std::int64_t time_ns) const {
    return pose_of(hand.side, hand.joints, place_at(time_ns) + glm::vec3(hand.aside_m, 0, 0));
  }
  Image<std::uint8_t> image_at(std::int64_t time_ns) const {
    Image<std::uint8_t> image = image_of(rig_, {pose_at(hands_[0], time_ns)});
    if (hands_.size() == 1) return image;
    const Image<std::uint8_t> other = image_of(rig_, {pose_at(hands_[1], time_ns)});
    std::transform(other.pixels().begin(), other.pixels().end(), image.pixels().begin(),
                   image.pixels().begin(), [](auto a, auto b) { return std::max(a, b); });
    return image;
  }
  msg::HandPoses reported(std::int64_t time_ns) const {
    msg::HandPoses poses = poses_of(time_ns, {});
    for (const Hand& hand : hands_) poses.hands[poses.count++] = pose_at(hand, time_ns);
    return poses;
  }
  msg::Landmarks detected(std::int64_t time_ns) const {
    msg::Landmarks all;
    for (const Hand& hand : hands_) {
      const msg::Landmarks one = landmarks_of(rig_, time_ns, pose_at(hand, time_ns), {3, 4});
      all.header = one.header;
      all.hands[all.count++] = one.hands[0];
    }
    return all;
  }

  calib::Calibration rig_;
  std::unique_ptr<Pipeline> pipeline_;
  std::vector<Hand> hands_;
  std::vector<Image<std::uint8_t>> images_;
  std::int64_t next_sample_ns_ = 0, next_detection_ns_ = 0;
};

}  // namespace

std::vector<FrameTimes> time_frames(std::span<const FrameScene> scenes, int frames) {
  constexpr int kTurn = 250, kWarmUp = 20;  // the first frames of a turn find cold caches
  std::vector<FrameTimes> times(scenes.size());
  std::vector<std::unique_ptr<Run>> runs;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    auto run = Run::start(scenes[i]);
    if (!run) times[i].error = run.error().what;
    runs.push_back(run ? std::move(*run) : nullptr);
  }
  for (int first = 0; first < frames; first += kTurn)
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (int frame = 0; runs[i] && frame < kTurn; ++frame)
        runs[i]->render(first + frame, times[i], frame >= kWarmUp);
  return times;
}

}  // namespace handcast::bench
