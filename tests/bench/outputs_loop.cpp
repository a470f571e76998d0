// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/outputs_loop.hpp"

#include "calib/sub_frames.hpp"
#include "config/sections/sub_frames.hpp"
#include "renderer/output/packing.hpp"
#include "services/projector/sub_frame_plan.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/swaying_hands.hpp"

namespace handcast::bench {

using projector::SubFramePlan;

SubFrameTimes draw_sub_frames(const config::Projector& settings, int sub_frames) {
  constexpr int kWarmUp = 5;  ///< output frames
  constexpr std::int64_t kTooLate_ns = 300'000;
  const auto output = rig_above_hands();
  SwayingHands hand(output);
  const auto calibration =
      config::has_half_size(settings.packing) ? calib::with_scaled_projector(output, 0.5) : output;
  const auto pipeline = renderer::Pipeline::create({}, {}, {}, calibration);
  const auto packer =
      renderer::make_packer(settings, output.projector.width_px, output.projector.height_px);
  SubFrameTimes times;
  if (!pipeline) return times;

  SubFramePlan plan(settings);
  const std::int64_t epoch_ns = now_ns() - 300'000'000, latency_ns = ms_to_ns(settings.latency_ms);
  const int each = config::sub_frames_of(settings.packing);
  std::int64_t first_ns = 0, last_ns = 0;
  for (int frame = -kWarmUp; times.sub_frames < sub_frames; ++frame) {
    double pack_us = 0, last_us = 0;
    int drawings = 0;
    std::vector<std::int64_t> begins_ns;  // of each sub-frame's drawing
    plan.start(now_ns());
    pack_us += timed_us([&] { packer->begin(1); });
    renderer::Frame drawn;
    while (const auto next = plan.next(now_ns())) {
      sleep_until_ns(next->begin_ns);
      const std::int64_t begin_ns = now_ns(), time_ns = begin_ns - epoch_ns;
      hand.deliver(**pipeline, time_ns);
      drawn = (*pipeline)->render(time_ns, next->target_ns - epoch_ns, hand.image(time_ns));
      last_us =
          timed_us([&] { packer->add(drawn.colour, drawn.region, next->first, next->count); });
      pack_us += last_us;
      plan.drawn(*next, now_ns() - begin_ns);
      begins_ns.insert(begins_ns.end(), static_cast<std::size_t>(next->count), begin_ns);
      ++drawings;
      if (frame >= 0) times.drawing_us.push_back(ns_to_ms(now_ns() - begin_ns) * 1e3);
    }
    const double end_us = timed_us([&] {
      if (const int left = plan.left_to_draw(); left > 0)
        packer->add(drawn.colour, drawn.region, each - left, left);
      packer->image();
    });
    begins_ns.resize(static_cast<std::size_t>(each), begins_ns.back());
    sleep_until_ns(plan.hand_over_ns());
    const std::int64_t handed_ns = now_ns();
    const std::int64_t late_ns = handed_ns - plan.hand_over_ns();
    plan.presented({handed_ns, handed_ns + latency_ns + plan.output_period_ns() / 2});
    if (frame < 0) continue;
    // Where the frame before was lit for more than its time, whole output frames are missing.
    const std::int64_t skipped =
        first_ns == 0
            ? 0
            : (handed_ns - last_ns + plan.output_period_ns() / 2) / plan.output_period_ns() - 1;
    if (first_ns == 0) first_ns = handed_ns;
    last_ns = handed_ns;
    const int with_frame = (static_cast<int>(skipped) + (late_ns < kTooLate_ns ? 0 : 1)) * each;
    times.missed += with_frame + (late_ns < kTooLate_ns ? each - drawings : 0);
    times.missed_with_frame += with_frame;
    for (const std::int64_t begin_ns : begins_ns)
      times.lead_ms.push_back(ns_to_ms(handed_ns - begin_ns));
    times.sub_frames += each;
    times.pack_us.push_back(pack_us + end_us);
    times.last_us.push_back(last_us + end_us);
    times.late_us.push_back(ns_to_ms(late_ns) * 1e3);
  }
  times.output_hz =
      static_cast<double>(times.pack_us.size() - 1) / ns_to_seconds(last_ns - first_ns);
  return times;
}

}  // namespace handcast::bench
