// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/frame_pipeline.hpp"

#include "renderer/pipeline/pipeline.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/swaying_hand.hpp"

namespace handcast::bench {

using namespace renderer;

FrameTimes time_frames(const config::Cascade& cascade, double distance_m, int frames) {
  constexpr std::int64_t kMs = 1'000'000, kFrame_ns = 1'000'000'000 / 946;
  constexpr int kWarmUp = 100;
  SwayingHand hand(distance_m);
  FrameTimes times;
  const auto pipeline = Pipeline::create(cascade, {}, {}, hand.calibration());
  if (!pipeline) {
    times.error = pipeline.error().what;
    return times;
  }
  for (int i = 0; i < kWarmUp + frames; ++i) {
    const std::int64_t now_ns = 300 * kMs + i * kFrame_ns;
    hand.deliver(**pipeline, now_ns);
    const TimedImage image = hand.image(now_ns);
    Frame frame;
    const double frame_us =
        timed_us([&] { frame = (*pipeline)->render(now_ns, now_ns + 4 * kMs, image); });
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
