// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/frame_pipeline.hpp"

#include "renderer/draw/cpu/cpu_painter.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/swaying_hands.hpp"

namespace handcast::bench {
namespace {

using namespace renderer;

constexpr std::int64_t kMs = 1'000'000, kFrame_ns = 1'000'000'000 / 946;

/// The reference rig at the distance of the scene, with the screen and the image grown around their
/// centres.
calib::Calibration rig_of(const FrameScene& scene) {
  calib::Calibration rig = rig_above_hands(scene.distance_m);
  const auto shift = [](glm::dvec2 by) { return glm::dmat3(1, 0, 0, 0, 1, 0, by.x, by.y, 1); };
  const glm::dvec2 more_image(0.5 * (scene.image_width_px - rig.camera.width_px),
                              0.5 * (scene.image_height_px - rig.camera.height_px)),
      more_screen(0.5 * (scene.screen_width_px - rig.projector.width_px),
                  0.5 * (scene.screen_height_px - rig.projector.height_px));
  rig.camera.cx_px += more_image.x;
  rig.camera.cy_px += more_image.y;
  rig.camera.width_px = scene.image_width_px;
  rig.camera.height_px = scene.image_height_px;
  rig.projector.from_camera = shift(more_screen) * rig.projector.from_camera * shift(-more_image);
  rig.projector.width_px = scene.screen_width_px;
  rig.projector.height_px = scene.screen_height_px;
  return rig;
}

/// One scene, frame by frame.
struct Run {
  SwayingHands hands;
  std::unique_ptr<Pipeline> pipeline;

  void render(int frame_index, FrameTimes& times, bool counts) {
    const std::int64_t now_ns = 300 * kMs + frame_index * kFrame_ns;
    hands.deliver(*pipeline, now_ns);
    const TimedImage image = hands.image(now_ns);
    Frame frame;
    const double frame_us =
        timed_us([&] { frame = pipeline->render(now_ns, now_ns + 4 * kMs, image); });
    times.lit_px = frame.fill.lit;
    times.filled_px = frame.fill.filled;
    times.region_px = frame.region.width() * frame.region.height();
    if (!counts) return;
    times.frame_us.push_back(frame_us);
    for (const msg::StageMark& mark : frame.stages)
      times.stage_us[std::string(msg::kStageNames[static_cast<std::size_t>(mark.stage)])].push_back(
          static_cast<double>(mark.end_ns - mark.begin_ns) / 1e3);
  }
};

}  // namespace

std::vector<FrameTimes> time_frames(std::span<const FrameScene> scenes, int frames) {
  constexpr int kTurn = 250, kWarmUp = 20;  // the first frames of a turn find cold caches
  std::vector<FrameTimes> times(scenes.size());
  std::vector<Run> runs;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const FrameScene& scene = scenes[i];
    const calib::Calibration rig = rig_of(scene);
    auto pipeline = Pipeline::create(
        scene.cascade, {.smooth = scene.smooth}, {}, rig, {},
        make_cpu_painter(scene.screen_width_px, scene.screen_height_px, scene.threads));
    if (!pipeline) {
      times[i].error = pipeline.error().what;
      return times;
    }
    runs.push_back({SwayingHands(rig, scene.hands, scene.pose), std::move(*pipeline)});
  }
  for (int first = 0; first < frames; first += kTurn)
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (int frame = 0; frame < kTurn; ++frame)
        runs[i].render(first + frame, times[i], frame >= kWarmUp);
  return times;
}

}  // namespace handcast::bench
